#include "synthesis/noise/fractal_noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "numerics/hash_random.h"
#include "numerics/portable_double.h"
#include "numerics/scalar_math.h"

namespace astrolith {
namespace fractal_noise {
namespace {

constexpr int kBatch = 256;  // ten arrays of this many floats stay in the first cache
using Batch = std::array<float, kBatch>;

ASTROLITH_SIMD_CLONES void place(int n, const float* __restrict p, float low, float high, float scale,
                                 float bias, float* __restrict q) {
#pragma omp simd
  for (int i = 0; i < n; ++i) q[i] = placed_coordinate(p[i], low, high, scale, bias);
}

// Writes the sum of the octaves at n <= kBatch arguments of the noise.
void sum_octaves(const FractalNoise& noise, std::span<const NoiseOctave> octaves, int n, const float* x,
                 const float* y, const float* z, float* height) {
  std::fill(height, height + n, 0.0f);
  if (noise.gradient_modulation == 0.0f) {
    for (const NoiseOctave& o : octaves) add_octave(noise.noise, o, n, x, y, z, height);
    return;
  }
  Batch dx{}, dy{}, dz{};
  for (const NoiseOctave& o : octaves) {
    add_modulated_octave(noise.noise, o, noise.gradient_modulation, n, x, y, z, dx.data(), dy.data(),
                         dz.data(), height);
  }
}

// Writes the heights of a noise with these octaves.
void evaluate_octaves(const FractalNoise& noise, std::span<const NoiseOctave> octaves,
                      const ArrayView& arrays, int count, const float* x, const float* y, const float* z,
                      float* height) {
  for (int begin = 0; begin < count; begin += kBatch) {
    const int n = std::min(kBatch, count - begin);
    Batch wx, wy, wz, qx, qy, qz;
    const float *px = x + begin, *py = y + begin, *pz = z + begin;
    if (noise.warped) {
      warp_points(noise.warp, arrays, n, px, py, pz, wx.data(), wy.data(), wz.data());
      px = wx.data();
      py = wy.data();
      pz = wz.data();
    }
    place(n, px, noise.low.x, noise.high.x, noise.scale.x, noise.bias.x, qx.data());
    place(n, py, noise.low.y, noise.high.y, noise.scale.y, noise.bias.y, qy.data());
    place(n, pz, noise.low.z, noise.high.z, noise.scale.z, noise.bias.z, qz.data());
    sum_octaves(noise, octaves, n, qx.data(), qy.data(), qz.data(), height + begin);
  }
}

}  // namespace
}  // namespace fractal_noise

namespace {

double farthest_coordinate(double low, double high, double scale, double bias) {
  return std::max(std::fabs(scale * low + bias), std::fabs(scale * high + bias));
}

// The argument of the noise at a point.
Vec3d placed(const FractalNoise& noise, const Vec3d& bias, const Vec3d& p) {
  return {double{noise.scale.x} * p.x + bias.x, double{noise.scale.y} * p.y + bias.y,
          double{noise.scale.z} * p.z + bias.z};
}

NoiseDetail noise_detail(const FractalLayer& layer, const FractalNoise& noise, std::size_t kept_octaves) {
  const double scale =
      std::max({std::fabs(layer.scale.x), std::fabs(layer.scale.y), std::fabs(layer.scale.z)});
  NoiseDetail detail;
  detail.finest =
      1.0 / (layer.frequency * portable::whole_power(layer.lacunarity, layer.octaves - 1) * scale);
  if (noise.warped) detail.finest = std::min(detail.finest, noise.warp.detail.finest);
  detail.left_out = share_left_out(kept_octaves, layer.octaves, layer.gain);
  return detail;
}

}  // namespace

FractalNoise make_noise(const FractalLayer& layer, std::uint64_t seed, int layer_index,
                        const NoiseFrame& frame, ArrayStore& arrays) {
  FractalNoise noise;
  noise.noise = layer.noise;
  noise.scale = to_float(layer.scale);
  // The octaves of a frame with an origin of its own hold the bias.
  const Vec3d bias = frame.moved ? Vec3d{} : layer.bias;
  noise.bias = to_float(bias);
  noise.gradient_modulation = static_cast<float>(layer.gradient_modulation);
  const std::uint32_t layer_seed = hash_seed(seed, static_cast<std::uint32_t>(layer_index));
  noise.warped = layer.warp.has_value();
  if (noise.warped) noise.warp = make_coordinate_warp(*layer.warp, layer_seed, frame, arrays);
  const Box reached = noise.warped ? widened(frame.domain, noise.warp.bound) : frame.domain;
  noise.low = to_float(reached.min);
  noise.high = to_float(reached.max);
  const double largest = std::max({farthest_coordinate(reached.min.x, reached.max.x, layer.scale.x, bias.x),
                                   farthest_coordinate(reached.min.y, reached.max.y, layer.scale.y, bias.y),
                                   farthest_coordinate(reached.min.z, reached.max.z, layer.scale.z, bias.z)});
  const Vec3d origin = frame.moved ? placed(noise, layer.bias, frame.origin) : Vec3d{};
  std::vector<NoiseOctave> octaves =
      make_octaves(layer.frequency, layer.amplitude * layer.weight, layer.octaves, layer.gain,
                   layer.lacunarity, {layer_seed}, NoiseFrame::farthest_distance(largest, origin));
  noise.detail = noise_detail(layer, noise, octaves.size());
  if (frame.moved) octaves = local_octaves(layer.noise, octaves, origin);
  noise.octaves = arrays.add(octaves);
  double amplitude = layer.amplitude * layer.weight;
  for (std::uint32_t o = 0; o < noise.octaves.count; ++o, amplitude *= layer.gain) {
    noise.height_bound += std::fabs(amplitude);
  }
  return noise;
}

void evaluate_heights(const FractalNoise& noise, const ArrayView& arrays, int count, const float* x,
                      const float* y, const float* z, float* height) {
  fractal_noise::evaluate_octaves(noise, arrays.span(noise.octaves), arrays, count, x, y, z, height);
}

namespace {

// The octaves of a noise relative to an origin.
std::vector<NoiseOctave> octaves_at(const FractalNoise& noise, const ArrayView& arrays, const Vec3d& origin) {
  const Vec3d bias{noise.bias.x, noise.bias.y, noise.bias.z};
  return local_octaves(noise.noise, arrays.span(noise.octaves), placed(noise, bias, origin));
}

// A noise without its bias and its domain, which octaves_at() do not have.
FractalNoise unplaced(FractalNoise noise) {
  constexpr float kEverywhere = std::numeric_limits<float>::max();
  noise.bias = {};
  noise.low = {-kEverywhere, -kEverywhere, -kEverywhere};
  noise.high = {kEverywhere, kEverywhere, kEverywhere};
  return noise;
}

}  // namespace

FractalNoise local_form(const FractalNoise& noise, const Vec3d& origin, ArrayStore& arrays) {
  FractalNoise local = unplaced(noise);
  local.octaves = arrays.add(octaves_at(noise, arrays.view(), origin));
  return local;
}

void evaluate_local_heights(const FractalNoise& noise, const ArrayView& arrays, const Vec3d& origin,
                            int count, const float* x, const float* y, const float* z, float* height) {
  fractal_noise::evaluate_octaves(unplaced(noise), octaves_at(noise, arrays, origin), arrays, count, x, y, z,
                                  height);
}

}  // namespace astrolith
