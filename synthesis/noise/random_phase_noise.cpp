#include "synthesis/noise/random_phase_noise.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "numerics/interval.h"
#include "numerics/random_direction.h"
#include "numerics/scalar_math.h"

namespace astrolith {
namespace {

constexpr int kChunk = 128;  // an array a corner's windows stays in the first cache
using Chunk = std::array<float, kChunk>;

constexpr double kMostTurns = 262144.0;  // 2^18: floats hold five bits of a turn
constexpr double kClip = 6.0;
constexpr std::uint32_t kWaveStream = 0x77617665u;

// Where the points of a chunk are in their cells, and the windows of the cells' corners.
struct Windows {
  std::array<Chunk, 8> weight;
  std::array<std::array<std::uint32_t, kChunk>, 8> corner;
  Chunk scale;  // 1 / norm
};

ASTROLITH_SIMD_CLONES void find_windows(int n, const float* __restrict x, const float* __restrict y,
                                        const float* __restrict z, float inverse_cell, float coherence,
                                        std::uint32_t seed, Windows& out) {
  for (unsigned c = 0; c < 8; ++c) {
    float* __restrict weight = out.weight[c].data();
    std::uint32_t* __restrict corner = out.corner[c].data();
#pragma omp simd
    for (int i = 0; i < n; ++i) {
      const PhaseCorner there =
          phase_corner(c, x[i] * inverse_cell, y[i] * inverse_cell, z[i] * inverse_cell, seed);
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

// height[i] += one wave as the cells around the points see it.
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

double coherence_of(double randomness) {
  const double x = 3.14159265358979323846 * randomness;
  return x > 0.0 ? std::pow(std::sin(x) / x, 2) : 1.0;
}

}  // namespace

RandomPhaseNoise::RandomPhaseNoise(const RandomPhaseLayer& layer, std::uint64_t seed, int layer_index,
                                   const Box& domain)
    : domain_min_(to_float(domain.min)),
      domain_max_(to_float(domain.max)),
      inverse_cell_(static_cast<float>(1.0 / layer.cell_size)),
      randomness_(static_cast<float>(layer.randomness)),
      coherence_(static_cast<float>(coherence_of(layer.randomness))),
      clip_(static_cast<float>(kClip * layer.height_rms)),
      seed_(hash_seed(seed, static_cast<std::uint32_t>(layer_index))) {
  const double farthest = largest_coordinate(domain);
  if (farthest / layer.cell_size > kLargestCell) return;
  std::vector<double> frequency;
  double power = 0.0;
  for (int j = 0; j < layer.waves; ++j) {
    const std::uint32_t h = hash_append(seed_ ^ kWaveStream, static_cast<std::uint32_t>(j));
    const double share = (j + static_cast<double>(unit_float(hash_append(h, 0)))) / layer.waves;
    frequency.push_back(layer.frequency_min + share * (layer.frequency_max - layer.frequency_min));
    power += std::pow(frequency.back() / layer.frequency_max, -layer.exponent);
  }
  for (int j = 0; j < layer.waves; ++j) {
    const double f = frequency[static_cast<std::size_t>(j)];
    if (std::sqrt(3.0) * f * farthest > kMostTurns) continue;
    const std::uint32_t h = hash_append(seed_ ^ kWaveStream, static_cast<std::uint32_t>(j));
    const Vec3f u = direction_in_cone(to_float(normalized(layer.direction)), static_cast<float>(layer.spread),
                                      unit_float(hash_append(h, 1)), unit_float(hash_append(h, 2)));
    const double amplitude =
        layer.height_rms * std::sqrt(2.0 * std::pow(f / layer.frequency_max, -layer.exponent) / power);
    waves_.push_back({u * static_cast<float>(f), unit_float(hash_append(h, 3)), static_cast<float>(amplitude),
                      hash_append(h, 4)});
  }
}

void RandomPhaseNoise::evaluate(int n, const float* x, const float* y, const float* z, float* height) const {
  for (int begin = 0; begin < n; begin += kChunk) {
    evaluate_chunk(std::min(kChunk, n - begin), x + begin, y + begin, z + begin, height + begin);
  }
}

void RandomPhaseNoise::evaluate_chunk(int n, const float* x, const float* y, const float* z,
                                      float* height) const {
  Chunk px{}, py{}, pz{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
    px[i] = math::clamp(x[i], domain_min_.x, domain_max_.x);
    py[i] = math::clamp(y[i], domain_min_.y, domain_max_.y);
    pz[i] = math::clamp(z[i], domain_min_.z, domain_max_.z);
  }
  Windows windows;
  find_windows(n, px.data(), py.data(), pz.data(), inverse_cell_, coherence_, seed_, windows);
  std::fill(height, height + n, 0.0f);
  for (const Wave& wave : waves_) {
    add_wave(wave, randomness_, n, px.data(), py.data(), pz.data(), windows, height);
  }
  for (int i = 0; i < n; ++i) {
    height[i] = math::clamp(height[i] * windows.scale[static_cast<std::size_t>(i)], -clip_, clip_);
  }
}

}  // namespace astrolith
