#include "synthesis/noise/fractal_noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "numerics/hash_random.h"
#include "numerics/scalar_math.h"
#include "synthesis/noise/octave_bounds.h"

namespace astrolith {
namespace {

constexpr int kChunk = 256;  // ten arrays of so many floats stay in the first cache over all octaves
using Chunk = std::array<float, kChunk>;

ASTROLITH_SIMD_CLONES void place(int n, const float* __restrict p, float low, float high, float scale,
                                 float bias, float* __restrict q) {
#pragma omp simd
  for (int i = 0; i < n; ++i) q[i] = placed_coordinate(p[i], low, high, scale, bias);
}

double farthest_coordinate(double low, double high, double scale, double bias) {
  return std::max(std::fabs(scale * low + bias), std::fabs(scale * high + bias));
}

}  // namespace

FractalNoise::FractalNoise(const FractalLayer& layer, std::uint64_t seed, int layer_index, const Box& domain)
    : noise_(layer.noise),
      scale_(to_float(layer.scale)),
      bias_(to_float(layer.bias)),
      gradient_modulation_(static_cast<float>(layer.gradient_modulation)) {
  const std::uint32_t layer_seed = hash_seed(seed, static_cast<std::uint32_t>(layer_index));
  if (layer.warp) warp_.emplace(*layer.warp, layer_seed, domain);
  const Box reached = warp_ ? widened(domain, warp_->bound()) : domain;
  domain_min_ = to_float(reached.min);
  domain_max_ = to_float(reached.max);
  const double farthest =
      std::max({farthest_coordinate(reached.min.x, reached.max.x, layer.scale.x, layer.bias.x),
                farthest_coordinate(reached.min.y, reached.max.y, layer.scale.y, layer.bias.y),
                farthest_coordinate(reached.min.z, reached.max.z, layer.scale.z, layer.bias.z)});
  octaves_ = make_octaves(layer.frequency, layer.amplitude * layer.weight, layer.octaves, layer.gain,
                          layer.lacunarity, {layer_seed}, farthest);
  double amplitude = layer.amplitude * layer.weight;
  for (std::size_t o = 0; o < octaves_.size(); ++o, amplitude *= layer.gain)
    height_bound_ += std::fabs(amplitude);
}

void FractalNoise::evaluate(int n, const float* x, const float* y, const float* z, float* height) const {
  for (int begin = 0; begin < n; begin += kChunk) {
    evaluate_chunk(std::min(kChunk, n - begin), x + begin, y + begin, z + begin, height + begin);
  }
}

void FractalNoise::evaluate_chunk(int n, const float* x, const float* y, const float* z,
                                  float* height) const {
  Chunk wx, wy, wz, qx, qy, qz;
  if (warp_) {
    warp_->evaluate(n, x, y, z, wx.data(), wy.data(), wz.data());
    x = wx.data();
    y = wy.data();
    z = wz.data();
  }
  place(n, x, domain_min_.x, domain_max_.x, scale_.x, bias_.x, qx.data());
  place(n, y, domain_min_.y, domain_max_.y, scale_.y, bias_.y, qy.data());
  place(n, z, domain_min_.z, domain_max_.z, scale_.z, bias_.z, qz.data());
  add_octaves(octaves_, n, qx.data(), qy.data(), qz.data(), height);
}

void FractalNoise::evaluate_near(const Vec3d& origin, int n, const float* x, const float* y, const float* z,
                                 float* height) const {
  constexpr float kEverywhere = std::numeric_limits<float>::max();
  const Vec3d scale{scale_.x, scale_.y, scale_.z}, bias{bias_.x, bias_.y, bias_.z};
  const Vec3d q{scale.x * origin.x + bias.x, scale.y * origin.y + bias.y, scale.z * origin.z + bias.z};
  const std::vector<NoiseOctave> octaves = octaves_near(noise_, octaves_, q);
  for (int begin = 0; begin < n; begin += kChunk) {
    const int size = std::min(kChunk, n - begin);
    Chunk qx, qy, qz;
    place(size, x + begin, -kEverywhere, kEverywhere, scale_.x, 0.0f, qx.data());
    place(size, y + begin, -kEverywhere, kEverywhere, scale_.y, 0.0f, qy.data());
    place(size, z + begin, -kEverywhere, kEverywhere, scale_.z, 0.0f, qz.data());
    add_octaves(octaves, size, qx.data(), qy.data(), qz.data(), height + begin);
  }
}

void FractalNoise::add_octaves(const std::vector<NoiseOctave>& octaves, int n, const float* x, const float* y,
                               const float* z, float* height) const {
  std::fill(height, height + n, 0.0f);
  if (gradient_modulation_ == 0.0f) {
    for (const NoiseOctave& o : octaves) add_octave(noise_, o, n, x, y, z, height);
    return;
  }
  Chunk dx{}, dy{}, dz{};
  for (const NoiseOctave& o : octaves) {
    add_modulated_octave(noise_, o, gradient_modulation_, n, x, y, z, dx.data(), dy.data(), dz.data(),
                         height);
  }
}

Interval FractalNoise::bound_heights(const Box& box) const {
  const Box p = warp_ ? warp_->image(box) : box;
  return bound_sum(noise_, octaves_, bound_placed(p, domain_min_, domain_max_, scale_, bias_),
                   gradient_modulation_ != 0.0f);
}

}  // namespace astrolith
