#include "synthesis/fractal_noise.h"

#include <algorithm>
#include <cmath>

#include "numerics/hash_random.h"
#include "synthesis/simplex_noise.h"

namespace astrolith {
namespace {

constexpr double kLargestLatticeCoordinate = 1048576.0;  // 2^20: leaves three bits within a cell

ASTROLITH_SIMD_CLONES void place(int n, const float* __restrict p, float low, float high, float scale,
                                 float bias, float* __restrict q) {
#pragma omp simd
  for (int i = 0; i < n; ++i) q[i] = math::fma(math::clamp(p[i], low, high), scale, bias);
}

ASTROLITH_SIMD_CLONES void add_octave(int n, const float* __restrict x, const float* __restrict y,
                                      const float* __restrict z, float frequency, float amplitude,
                                      std::uint32_t seed, float* __restrict height) {
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    const float noise = simplex_noise(frequency * x[i], frequency * y[i], frequency * z[i], seed);
    height[i] = math::fma(amplitude, noise, height[i]);
  }
}

double farthest_coordinate(double low, double high, double scale, double bias) {
  return std::max(std::fabs(scale * low + bias), std::fabs(scale * high + bias));
}

Vec3f to_float(const Vec3d& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

}  // namespace

FractalNoise::FractalNoise(const FractalLayer& layer, std::uint64_t seed, int layer_index, const Box& domain)
    : scale_(to_float(layer.scale)),
      bias_(to_float(layer.bias)),
      domain_min_(to_float(domain.min)),
      domain_max_(to_float(domain.max)) {
  const double farthest =
      std::max({farthest_coordinate(domain.min.x, domain.max.x, layer.scale.x, layer.bias.x),
                farthest_coordinate(domain.min.y, domain.max.y, layer.scale.y, layer.bias.y),
                farthest_coordinate(domain.min.z, domain.max.z, layer.scale.z, layer.bias.z)});
  const std::uint32_t layer_seed = hash_seed(seed, static_cast<std::uint32_t>(layer_index));
  double frequency = layer.frequency, amplitude = layer.amplitude * layer.weight;
  for (int o = 0; o < layer.octaves; ++o) {
    if (!(frequency * farthest <= kLargestLatticeCoordinate)) break;
    octaves_.push_back({static_cast<float>(frequency), static_cast<float>(amplitude),
                        hash_append(layer_seed, static_cast<std::uint32_t>(o))});
    height_bound_ += std::fabs(amplitude);
    frequency *= layer.lacunarity;
    amplitude *= layer.gain;
  }
}

void FractalNoise::evaluate(int n, const float* x, const float* y, const float* z, float* height,
                            float* scratch) const {
  float* qx = scratch;
  float* qy = scratch + n;
  float* qz = scratch + 2 * n;
  place(n, x, domain_min_.x, domain_max_.x, scale_.x, bias_.x, qx);
  place(n, y, domain_min_.y, domain_max_.y, scale_.y, bias_.y, qy);
  place(n, z, domain_min_.z, domain_max_.z, scale_.z, bias_.z, qz);
  std::fill(height, height + n, 0.0f);
  for (const Octave& o : octaves_) add_octave(n, qx, qy, qz, o.frequency, o.amplitude, o.seed, height);
}

}  // namespace astrolith
