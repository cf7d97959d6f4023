#include "synthesis/sparse_noise.h"

#include <algorithm>
#include <cmath>

#include "numerics/hash_random.h"
#include "synthesis/largest_coordinate.h"

namespace astrolith {
namespace {

constexpr double kLargestCell =
    1048576.0;                        // 2^20 cells from the origin: floats hold three bits within a cell
constexpr double kMostCells = 512.0;  // looked at one by one for a bound
constexpr double kSlack = 1e-5;       // relative, for the rounding of positions and sums

ASTROLITH_SIMD_CLONES void upscale(int n, const float* __restrict x, const float* __restrict y,
                                   const float* __restrict z, float frequency, std::uint32_t seed,
                                   float probability, float inverse_probability, float* __restrict noise) {
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    noise[i] = upscaled_noise(frequency * x[i], frequency * y[i], frequency * z[i], seed, probability,
                              inverse_probability);
  }
}

// The greatest weight that a cell's bump has from low to high, in cells from its centre.
double greatest_weight(double low, double high) {
  const double d = std::max({0.0, low, -high});
  return d <= 0.5 ? 0.75 - d * d : d < 1.5 ? 0.5 * (1.5 - d) * (1.5 - d) : 0.0;
}

}  // namespace

SparseNoise::SparseNoise(const SparseLayer& layer, std::uint64_t seed, int layer_index, const Box& domain)
    : amplitude_(static_cast<float>(layer.amplitude)),
      threshold_(static_cast<float>(layer.threshold)),
      probability_(static_cast<float>(layer.probability)),
      inverse_probability_(layer.probability > 0.0 ? static_cast<float>(1.0 / layer.probability) : 0.0f),
      merged_(layer.merged),
      domain_min_{static_cast<float>(domain.min.x), static_cast<float>(domain.min.y),
                  static_cast<float>(domain.min.z)},
      domain_max_{static_cast<float>(domain.max.x), static_cast<float>(domain.max.y),
                  static_cast<float>(domain.max.z)} {
  const std::uint32_t layer_seed = hash_seed(seed, static_cast<std::uint32_t>(layer_index));
  double gains = 0.0, gain = 1.0, cell = layer.cell_size;
  for (int l = 0; l < layer.levels; ++l, gain *= layer.gain, cell *= 0.5) {
    if (!(largest_coordinate(domain) / cell <= kLargestCell)) break;
    levels_.push_back({static_cast<float>(1.0 / cell), static_cast<float>(gain),
                       hash_append(layer_seed, static_cast<std::uint32_t>(l))});
    gains += gain;
  }
  const double greatest = double{kInverseBumpHeight};
  const double deepest = merged_ ? greatest * gains - layer.threshold : gains * (greatest - layer.threshold);
  height_bound_ = std::fabs(layer.amplitude) * std::max(deepest, 0.0) * (1.0 + kSlack);
}

void SparseNoise::evaluate(int n, const float* x, const float* y, const float* z, float* height) const {
  std::vector<float> points(static_cast<std::size_t>(4 * n));
  float *px = points.data(), *py = px + n, *pz = py + n, *noise = pz + n;
  for (int i = 0; i < n; ++i) {
    px[i] = math::clamp(x[i], domain_min_.x, domain_max_.x);
    py[i] = math::clamp(y[i], domain_min_.y, domain_max_.y);
    pz[i] = math::clamp(z[i], domain_min_.z, domain_max_.z);
  }
  std::fill(height, height + n, 0.0f);
  const Parts part = parts();
  for (const SparseLevel& level : levels_) {
    upscale(n, px, py, pz, level.frequency, level.seed, probability_, inverse_probability_, noise);
    for (int i = 0; i < n; ++i)
      height[i] = with_sparse_level(level.gain, noise[i], part.level_cut, height[i]);
  }
  for (int i = 0; i < n; ++i) height[i] = sparse_height(amplitude_, height[i], part.sum_cut);
}

double SparseNoise::greatest_noise(const SparseLevel& level, const Box& box) const {
  const double f = double{level.frequency};
  const double rounding = 1e-6 * (1.0 + f * largest_coordinate(box));
  const Vec3d low = f * box.min - Vec3d{rounding, rounding, rounding},
              high = f * box.max + Vec3d{rounding, rounding, rounding};
  const auto first = [](double c) { return std::floor(c + 0.5) - 1.0; };
  const auto last = [](double c) { return std::floor(c + 0.5) + 1.0; };
  const double cells = (last(high.x) - first(low.x) + 1.0) * (last(high.y) - first(low.y) + 1.0) *
                       (last(high.z) - first(low.z) + 1.0);
  if (!(cells <= kMostCells)) return double{kInverseBumpHeight};
  double sum = 0.0;
  for (double k = first(low.z); k <= last(high.z); ++k) {
    const double wz = greatest_weight(low.z - k, high.z - k);
    for (double j = first(low.y); j <= last(high.y); ++j) {
      const double wy = greatest_weight(low.y - j, high.y - j);
      for (double i = first(low.x); i <= last(high.x); ++i) {
        sum += wz * wy * greatest_weight(low.x - i, high.x - i) *
               double{sparse_value(static_cast<float>(i), static_cast<float>(j), static_cast<float>(k),
                                   level.seed, probability_, inverse_probability_)};
      }
    }
  }
  return std::min(sum * (1.0 + kSlack), 1.0) * double{kInverseBumpHeight};  // the weights add up to 1
}

Interval SparseNoise::bound_heights(const Box& box) const {
  const auto inside = [&](const Vec3d& p) {
    return Vec3d{std::clamp(p.x, double{domain_min_.x}, double{domain_max_.x}),
                 std::clamp(p.y, double{domain_min_.y}, double{domain_max_.y}),
                 std::clamp(p.z, double{domain_min_.z}, double{domain_max_.z})};
  };
  const Box moved{inside(box.min), inside(box.max)};
  const double threshold = double{threshold_};
  double deepest = 0.0;
  for (const SparseLevel& level : levels_) {
    const double noise = greatest_noise(level, moved);
    deepest += double{level.gain} * (merged_ ? noise : std::max(noise - threshold, 0.0));
  }
  if (merged_) deepest = std::max(deepest - threshold, 0.0);
  const double reach = std::fabs(double{amplitude_}) * deepest + kSlack * height_bound_;
  return amplitude_ > 0.0f ? Interval{-reach, kSlack * height_bound_}
                           : Interval{-kSlack * height_bound_, reach};
}

}  // namespace astrolith
