#include "synthesis/noise/coordinate_warp.h"

#include <algorithm>
#include <cmath>

#include "numerics/hash_random.h"
#include "numerics/portable_double.h"
#include "numerics/scalar_math.h"

namespace astrolith {
namespace {

constexpr std::uint32_t kWarpStream = 0x77617270u;  // far from the stream numbers of the octaves of layers

ASTROLITH_SIMD_CLONES void clamp_all(int n, const float* __restrict p, float low, float high,
                                     float* __restrict clamped) {
#pragma omp simd
  for (int i = 0; i < n; ++i) clamped[i] = math::clamp(p[i], low, high);
}

}  // namespace

CoordinateWarp make_coordinate_warp(const Warp& warp, std::uint32_t seed, const NoiseFrame& frame,
                                    ArrayStore& arrays) {
  double largest = 0.0, amplitude = std::fabs(warp.amplitude);
  for (int o = 0; o < warp.octaves; ++o, amplitude *= warp.gain) largest += amplitude;
  const Box reached = widened(frame.domain, largest);
  CoordinateWarp made;
  made.low = to_float(reached.min);
  made.high = to_float(reached.max);
  const double farthest = NoiseFrame::farthest_distance(largest_coordinate(reached), frame.origin);
  made.detail.finest = 1.0 / (warp.frequency * portable::whole_power(warp.lacunarity, warp.octaves - 1));
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    std::vector<NoiseOctave> octaves = make_octaves(warp.frequency, warp.amplitude, warp.octaves, warp.gain,
                                                    warp.lacunarity, {seed, kWarpStream + axis, 3}, farthest);
    if (frame.moved) octaves = local_octaves(Noise::kSimplex, octaves, frame.origin);
    made.octaves[axis] = arrays.add(octaves);
    if (axis != 0) continue;
    made.detail.left_out = share_left_out(octaves.size(), warp.octaves, warp.gain);
    made.bound = sum_bound(octaves) * (1.0 + 1e-5) + 1e-6 * farthest;
    // The gradients of the three displacements are the rows of the derivative of warp(p).
    made.lipschitz_bound = 1.0 + std::sqrt(3.0) * slope_bound(Noise::kSimplex, octaves);
  }
  return made;
}

void warp_points(const CoordinateWarp& warp, const ArrayView& arrays, int n, const float* x, const float* y,
                 const float* z, float* wx, float* wy, float* wz) {
  constexpr int kBatch = 256;
  std::array<float, kBatch> cx, cy, cz;
  for (int begin = 0; begin < n; begin += kBatch) {
    const int size = std::min(kBatch, n - begin);
    clamp_all(size, x + begin, warp.low.x, warp.high.x, cx.data());
    clamp_all(size, y + begin, warp.low.y, warp.high.y, cy.data());
    clamp_all(size, z + begin, warp.low.z, warp.high.z, cz.data());
    const std::array<const float*, 3> from{x + begin, y + begin, z + begin};
    const std::array<float*, 3> to{wx + begin, wy + begin, wz + begin};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::copy_n(from[axis], size, to[axis]);
      for (const NoiseOctave& o : arrays.span(warp.octaves[axis])) {
        add_octave(Noise::kSimplex, o, size, cx.data(), cy.data(), cz.data(), to[axis]);
      }
    }
  }
}

}  // namespace astrolith
