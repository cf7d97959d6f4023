#include "synthesis/noise/sparse_noise.h"

#include <algorithm>
#include <cmath>

#include "numerics/hash_random.h"
#include "synthesis/noise/sparse_bounds.h"

namespace astrolith {
namespace {

ASTROLITH_SIMD_CLONES void upscale(int n, const float* __restrict x, const float* __restrict y,
                                   const float* __restrict z, float frequency, std::uint32_t seed,
                                   float probability, float inverse_probability, float* __restrict noise) {
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    noise[i] = upscaled_noise(frequency * x[i], frequency * y[i], frequency * z[i], seed, probability,
                              inverse_probability);
  }
}

}  // namespace

SparseNoise::SparseNoise(const SparseLayer& layer, std::uint64_t seed, int layer_index, const Box& domain)
    : amplitude_(static_cast<float>(layer.amplitude)),
      threshold_(static_cast<float>(layer.threshold)),
      probability_(static_cast<float>(layer.probability)),
      inverse_probability_(layer.probability > 0.0 ? static_cast<float>(1.0 / layer.probability) : 0.0f),
      merged_(layer.merged),
      domain_min_(to_float(domain.min)),
      domain_max_(to_float(domain.max)) {
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
  height_bound_ = std::fabs(layer.amplitude) * std::max(deepest, 0.0) * (1.0 + kSparseSlack);
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

Interval SparseNoise::bound_heights(const Box& box) const {
  const Parts p = parts();
  return bound_sparse_heights(p.levels.data(), static_cast<std::uint32_t>(p.levels.size()), p.probability,
                              p.inverse_probability, p.amplitude, p.level_cut, p.sum_cut, height_bound_,
                              moved_into(box, domain_min_, domain_max_));
}

}  // namespace astrolith
