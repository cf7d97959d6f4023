#include "synthesis/noise/random_phase_noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "numerics/interval.h"
#include "numerics/portable_angles.h"
#include "numerics/portable_double.h"
#include "numerics/random_direction.h"
#include "numerics/scalar_math.h"
#include "synthesis/noise/points_in_domain.h"

namespace astrolith {
namespace {

constexpr double kMostTurns = 262144.0;  // 2^18, where a float holds five bits of a turn
constexpr double kClip = 6.0;
constexpr std::uint32_t kWaveStream = 0x77617665u;

// The windows and hashes of the eight corners around each point of a batch.
struct Windows {
  static constexpr int kBatch = 128;  // the windows stay in the first cache
  std::array<std::array<float, kBatch>, 8> weight;
  std::array<std::array<std::uint32_t, kBatch>, 8> corner;
  std::array<float, kBatch> scale;  // 1 / norm
};

ASTROLITH_SIMD_CLONES void find_windows(int n, const float* __restrict x, const float* __restrict y,
                                        const float* __restrict z, float inverse_cell, Vec3f offset,
                                        float coherence, std::uint32_t seed, Windows& out) {
  for (unsigned c = 0; c < 8; ++c) {
    float* __restrict weight = out.weight[c].data();
    std::uint32_t* __restrict corner = out.corner[c].data();
#pragma omp simd
    for (int i = 0; i < n; ++i) {
      const PhaseCorner there =
          phase_corner(c, math::fma(x[i], inverse_cell, offset.x), math::fma(y[i], inverse_cell, offset.y),
                       math::fma(z[i], inverse_cell, offset.z), seed);
      weight[i] = there.weight;
      corner[i] = there.hash;
    }
  }
  float* __restrict scale = out.scale.data();
  for (int i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    float sum = 0.0f;
    for (unsigned c = 0; c < 8; ++c) sum += out.weight[c][k];
    scale[i] = phase_scale(coherence, sum);
  }
}

// Adds one wave to the heights, with the phases of the eight corners around each point.
ASTROLITH_SIMD_CLONES void add_wave(const Wave& wave, float randomness, int n, const float* __restrict x,
                                    const float* __restrict y, const float* __restrict z,
                                    const Windows& windows, float* __restrict height) {
  const Wave w = wave;
  for (unsigned c = 0; c < 8; ++c) {
    const float* __restrict weight = windows.weight[c].data();
    const std::uint32_t* __restrict corner = windows.corner[c].data();
#pragma omp simd
    for (int i = 0; i < n; ++i) {
      height[i] = with_wave(w, randomness, {weight[i], corner[i]}, x[i], y[i], z[i], height[i]);
    }
  }
}

double phase_coherence(double randomness) {
  const double x = std::numbers::pi * randomness;
  return x > 0.0 ? portable::whole_power(portable::sin(x) / x, 2) : 1.0;
}

// The frequencies of all waves, in cycles per length unit. Each lies in its own equal share of the band.
std::vector<double> wave_frequencies(const RandomPhaseLayer& layer, std::uint32_t seed) {
  std::vector<double> frequencies;
  for (int j = 0; j < layer.waves; ++j) {
    const std::uint32_t h = hash_append(seed ^ kWaveStream, static_cast<std::uint32_t>(j));
    const double share = (j + static_cast<double>(unit_float(hash_append(h, 0)))) / layer.waves;
    frequencies.push_back(layer.frequency_min + share * (layer.frequency_max - layer.frequency_min));
  }
  return frequencies;
}

// The phase of a wave at the origin of a frame, in turns; the phase at the body's origin if that is the same.
float phase_at(const Vec3f& frequency, float phase, const Vec3d& origin) {
  const double turns = double{frequency.x} * origin.x + double{frequency.y} * origin.y +
                       double{frequency.z} * origin.z + double{phase};
  return static_cast<float>(turns - std::floor(turns));
}

// Waves too fine for the frame are left out; `left_out` becomes their share of the variance.
std::vector<Wave> draw_waves(const RandomPhaseLayer& layer, std::uint32_t seed, const NoiseFrame& frame,
                             double& left_out) {
  const std::vector<double> frequencies = wave_frequencies(layer, seed);
  double power = 0.0;
  for (const double f : frequencies) power += portable::pow(f / layer.frequency_max, -layer.exponent);
  std::vector<Wave> waves;
  for (std::size_t j = 0; j < frequencies.size(); ++j) {
    const double f = frequencies[j];
    const double share = portable::pow(f / layer.frequency_max, -layer.exponent) / power;
    if (std::sqrt(3.0) * f * frame.farthest() > kMostTurns) {
      left_out += share;
      continue;
    }
    const std::uint32_t h = hash_append(seed ^ kWaveStream, static_cast<std::uint32_t>(j));
    const Vec3f u = direction_in_cone(to_float(normalized(layer.direction)), static_cast<float>(layer.spread),
                                      unit_float(hash_append(h, 1)), unit_float(hash_append(h, 2)));
    const double amplitude =
        layer.height_rms * std::sqrt(2.0 * portable::pow(f / layer.frequency_max, -layer.exponent) / power);
    const Vec3f frequency = u * static_cast<float>(f);
    waves.push_back({frequency, phase_at(frequency, unit_float(hash_append(h, 3)), frame.origin),
                     static_cast<float>(amplitude), hash_append(h, 4)});
  }
  return waves;
}

// Writes the heights at n <= Windows::kBatch points of the domain.
void evaluate_batch(const RandomPhaseNoise& noise, std::span<const Wave> waves, int n, const float* x,
                    const float* y, const float* z, float* height) {
  Windows windows;
  find_windows(n, x, y, z, noise.inverse_cell, noise.offset, noise.coherence, noise.seed, windows);
  std::fill(height, height + n, 0.0f);
  for (const Wave& wave : waves) add_wave(wave, noise.randomness, n, x, y, z, windows, height);
  for (int i = 0; i < n; ++i) {
    height[i] = math::clamp(height[i] * windows.scale[static_cast<std::size_t>(i)], -noise.clip, noise.clip);
  }
}

}  // namespace

RandomPhaseNoise make_noise(const RandomPhaseLayer& layer, std::uint64_t seed, int layer_index,
                            const NoiseFrame& frame, ArrayStore& arrays) {
  RandomPhaseNoise noise;
  noise.low = to_float(frame.domain.min);
  noise.high = to_float(frame.domain.max);
  noise.inverse_cell = static_cast<float>(1.0 / layer.cell_size);
  noise.randomness = static_cast<float>(layer.randomness);
  noise.coherence = static_cast<float>(phase_coherence(layer.randomness));
  noise.clip = static_cast<float>(kClip * layer.height_rms);
  noise.seed = hash_seed(seed, static_cast<std::uint32_t>(layer_index));
  noise.height_bound = static_cast<double>(noise.clip);
  noise.detail = {std::min(layer.cell_size, 1.0 / layer.frequency_max), 1.0};
  if (!(frame.farthest() / layer.cell_size <= kLargestCell)) return noise;
  noise.detail.left_out = 0.0;
  noise.waves = arrays.add(draw_waves(layer, noise.seed, frame, noise.detail.left_out));
  const OriginCell origin = origin_cell(double{noise.inverse_cell} * frame.origin);
  noise.seed += lattice_step(origin.x, origin.y, origin.z);
  noise.offset = to_float(origin.rest);
  return noise;
}

void evaluate_heights(const RandomPhaseNoise& noise, const ArrayView& arrays, int count, const float* x,
                      const float* y, const float* z, float* height) {
  const PointsInDomain p(noise.low, noise.high, count, x, y, z);
  for (int begin = 0; begin < count; begin += Windows::kBatch) {
    evaluate_batch(noise, arrays.span(noise.waves), std::min(Windows::kBatch, count - begin), p.x() + begin,
                   p.y() + begin, p.z() + begin, height + begin);
  }
}

}  // namespace astrolith
