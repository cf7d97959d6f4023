// The metaballs' field over many points at once.
#include <algorithm>
#include <array>

#include "synthesis/body/metaball_body.h"

namespace astrolith {
namespace {

// Points whose sums stay in registers while all spheres are added.
constexpr int kPointsInRegisters = 16;

// Writes the sums over the spheres at n points. Each kernel has its own loop: a choice inside the loop would
// keep it from vectorising.
#define ASTROLITH_SPHERES_LOOP(name, accumulate)                                                            \
  ASTROLITH_SIMD_CLONES void name(                                                                          \
      const MetaballParameters<float>& body, const MetaballSphere<float>* spheres, std::size_t num_spheres, \
      int n, const float* __restrict x, const float* __restrict y, const float* __restrict z,               \
      float* __restrict kernel, float* __restrict wx, float* __restrict wy, float* __restrict wz) {         \
    const MetaballParameters<float> parameters = body;                                                      \
    for (int begin = 0; begin < n; begin += kPointsInRegisters) {                                           \
      const int size = std::min(kPointsInRegisters, n - begin);                                             \
      float px[kPointsInRegisters] = {}, py[kPointsInRegisters] = {}, pz[kPointsInRegisters] = {};          \
      float sum[kPointsInRegisters] = {}, sx[kPointsInRegisters] = {}, sy[kPointsInRegisters] = {},         \
            sz[kPointsInRegisters] = {};                                                                    \
      for (int i = 0; i < size; ++i) px[i] = x[begin + i], py[i] = y[begin + i], pz[i] = z[begin + i];      \
      for (std::size_t j = 0; j < num_spheres; ++j) {                                                       \
        const MetaballSphere<float> sphere = spheres[j];                                                    \
        _Pragma("omp simd") for (int i = 0; i < kPointsInRegisters; ++i) {                                  \
          MetaballSums<float> sums{sum[i], {sx[i], sy[i], sz[i]}};                                          \
          accumulate(parameters, sphere, Vec3f{px[i], py[i], pz[i]}, sums);                                 \
          sum[i] = sums.kernel;                                                                             \
          sx[i] = sums.weighted.x;                                                                          \
          sy[i] = sums.weighted.y;                                                                          \
          sz[i] = sums.weighted.z;                                                                          \
        }                                                                                                   \
      }                                                                                                     \
      for (int i = 0; i < size; ++i) {                                                                      \
        kernel[begin + i] = sum[i];                                                                         \
        wx[begin + i] = sx[i];                                                                              \
        wy[begin + i] = sy[i];                                                                              \
        wz[begin + i] = sz[i];                                                                              \
      }                                                                                                     \
    }                                                                                                       \
  }
ASTROLITH_SPHERES_LOOP(add_gaussians, accumulate_gaussian)
ASTROLITH_SPHERES_LOOP(add_metaballs, accumulate_compact<Kernel::kMetaball>)
ASTROLITH_SPHERES_LOOP(add_soft_objects, accumulate_compact<Kernel::kSoftObject>)
ASTROLITH_SPHERES_LOOP(add_wyvill, accumulate_compact<Kernel::kWyvill>)
ASTROLITH_SPHERES_LOOP(add_cauchy, accumulate_compact<Kernel::kCauchy>)
#undef ASTROLITH_SPHERES_LOOP

auto make_adder(Kernel kernel) {
  switch (kernel) {
    case Kernel::kMetaball:
      return add_metaballs;
    case Kernel::kSoftObject:
      return add_soft_objects;
    case Kernel::kWyvill:
      return add_wyvill;
    case Kernel::kCauchy:
      return add_cauchy;
    default:
      return add_gaussians;
  }
}

// The four sums of the subtractive spheres at up to this many points. They stay in the first cache over all
// spheres.
struct SubtractedSums {
  static constexpr int kBatch = 256;
  std::array<float, kBatch> kernel, wx, wy, wz;
};

// Replaces the sums of the spheres that add by the net sums.
ASTROLITH_SIMD_CLONES void subtract_sums(const SubtractedSums& subtracted, int n, float* __restrict kernel,
                                         float* __restrict wx, float* __restrict wy, float* __restrict wz) {
  const float *tk = subtracted.kernel.data(), *tx = subtracted.wx.data(), *ty = subtracted.wy.data(),
              *tz = subtracted.wz.data();
  _Pragma("omp simd") for (int i = 0; i < n; ++i) {
    const MetaballSums<float> net = net_sums(MetaballSums<float>{kernel[i], {wx[i], wy[i], wz[i]}},
                                             MetaballSums<float>{tk[i], {tx[i], ty[i], tz[i]}});
    kernel[i] = net.kernel;
    wx[i] = net.weighted.x;
    wy[i] = net.weighted.y;
    wz[i] = net.weighted.z;
  }
}

// Replaces the sums by s and grad L.
#define ASTROLITH_FINISH_LOOP(name, finish)                                                               \
  ASTROLITH_SIMD_CLONES void name(const MetaballParameters<float>& body, int n, float* __restrict kernel, \
                                  float* __restrict wx, float* __restrict wy, float* __restrict wz) {     \
    const MetaballParameters<float> parameters = body;                                                    \
    _Pragma("omp simd") for (int i = 0; i < n; ++i) {                                                     \
      const SurfaceDistance<float> d =                                                                    \
          finish(parameters, MetaballSums<float>{kernel[i], {wx[i], wy[i], wz[i]}});                      \
      kernel[i] = d.distance;                                                                             \
      wx[i] = d.log_gradient.x;                                                                           \
      wy[i] = d.log_gradient.y;                                                                           \
      wz[i] = d.log_gradient.z;                                                                           \
    }                                                                                                     \
  }
ASTROLITH_FINISH_LOOP(finish_gaussians, gaussian_distance)
ASTROLITH_FINISH_LOOP(finish_compact, compact_distance)
#undef ASTROLITH_FINISH_LOOP

std::vector<MetaballSphere<float>> as_adding(std::span<const MetaballSphere<float>> subtractive) {
  std::vector<MetaballSphere<float>> spheres;
  for (const MetaballSphere<float>& s : subtractive) spheres.push_back(s.as_adding());
  return spheres;
}

}  // namespace

void evaluate_metaballs(const MetaballsView& metaballs, int n, const float* x, const float* y, const float* z,
                        float* distance, float* gradient_x, float* gradient_y, float* gradient_z) {
  const MetaballParameters<float>& body = metaballs.parameters;
  const std::span<const MetaballSphere<float>> adding = metaballs.adding();
  const std::vector<MetaballSphere<float>> subtractive = as_adding(metaballs.subtractive());
  const auto add = make_adder(body.compact_kernel.kernel);
  const auto finish = body.compact_kernel.kernel == Kernel::kGaussian ? finish_gaussians : finish_compact;
  for (int begin = 0; begin < n; begin += SubtractedSums::kBatch) {
    const int size = std::min(SubtractedSums::kBatch, n - begin);
    float *s = distance + begin, *gx = gradient_x + begin, *gy = gradient_y + begin, *gz = gradient_z + begin;
    add(body, adding.data(), adding.size(), size, x + begin, y + begin, z + begin, s, gx, gy, gz);
    if (!subtractive.empty()) {
      SubtractedSums subtracted;
      add(body, subtractive.data(), subtractive.size(), size, x + begin, y + begin, z + begin,
          subtracted.kernel.data(), subtracted.wx.data(), subtracted.wy.data(), subtracted.wz.data());
      subtract_sums(subtracted, size, s, gx, gy, gz);
    }
    finish(body, size, s, gx, gy, gz);
  }
}

}  // namespace astrolith
