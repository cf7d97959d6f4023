#include "synthesis/noise/coordinate_warp.h"

#include <algorithm>
#include <cmath>

#include "numerics/hash_random.h"
#include "numerics/scalar_math.h"
#include "synthesis/noise/octave_bounds.h"

namespace astrolith {
namespace {

constexpr std::uint32_t kWarpStream = 0x77617270u;  // far from the numbers of layers' octaves
constexpr int kChunk = 256;

ASTROLITH_SIMD_CLONES void clamp_all(int n, const float* __restrict p, float low, float high,
                                     float* __restrict clamped) {
#pragma omp simd
  for (int i = 0; i < n; ++i) clamped[i] = math::clamp(p[i], low, high);
}

}  // namespace

CoordinateWarp::CoordinateWarp(const Warp& warp, std::uint32_t seed, const Box& domain) {
  double largest = 0.0, amplitude = std::fabs(warp.amplitude);
  for (int o = 0; o < warp.octaves; ++o, amplitude *= warp.gain) largest += amplitude;
  const Box reached = widened(domain, largest);
  domain_min_ = to_float(reached.min);
  domain_max_ = to_float(reached.max);
  const double farthest = largest_coordinate(reached);
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    octaves_[axis] = make_octaves(warp.frequency, warp.amplitude, warp.octaves, warp.gain, warp.lacunarity,
                                  {seed, kWarpStream + axis, 3}, farthest);
  }
  bound_ = sum_bound(octaves_[0]) * (1.0 + 1e-5) + 1e-6 * farthest;
  // The three displacements' gradients are the rows of the derivative.
  lipschitz_bound_ = 1.0 + std::sqrt(3.0) * slope_bound(Noise::kSimplex, octaves_[0]);
}

void CoordinateWarp::evaluate(int n, const float* x, const float* y, const float* z, float* wx, float* wy,
                              float* wz) const {
  std::array<float, kChunk> cx, cy, cz;
  for (int begin = 0; begin < n; begin += kChunk) {
    const int size = std::min(kChunk, n - begin);
    clamp_all(size, x + begin, domain_min_.x, domain_max_.x, cx.data());
    clamp_all(size, y + begin, domain_min_.y, domain_max_.y, cy.data());
    clamp_all(size, z + begin, domain_min_.z, domain_max_.z, cz.data());
    const std::array<const float*, 3> from{x + begin, y + begin, z + begin};
    const std::array<float*, 3> to{wx + begin, wy + begin, wz + begin};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::copy_n(from[axis], size, to[axis]);
      for (const NoiseOctave& o : octaves_[axis]) {
        add_octave(Noise::kSimplex, o, size, cx.data(), cy.data(), cz.data(), to[axis]);
      }
    }
  }
}

Box CoordinateWarp::image(const Box& box) const {
  const Box inside = moved_into(box, domain_min_, domain_max_);
  const auto displacement = [&](std::size_t axis) {
    return bound_sum(Noise::kSimplex, octaves_[axis], inside, false);
  };
  return displaced_box(box, displacement(0), displacement(1), displacement(2), bound_);
}

}  // namespace astrolith
