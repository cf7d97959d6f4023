#include "synthesis/noise/sparse_noise.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "numerics/hash_random.h"
#include "numerics/portable_double.h"
#include "synthesis/noise/noise_octaves.h"
#include "synthesis/noise/points_in_domain.h"

namespace astrolith {
namespace {

ASTROLITH_SIMD_CLONES void add_level(const SparseNoise& given, const SparseLevel& sparse_level, int n,
                                     const float* __restrict x, const float* __restrict y,
                                     const float* __restrict z, float* __restrict sum) {
  const SparseLevel level = sparse_level;
  const float probability = given.probability, inverse = given.inverse_probability, cut = given.level_cut;
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    const float noise = sparse_noise(level, probability, inverse, x[i], y[i], z[i]);
    sum[i] = with_sparse_level(level.gain, noise, cut, sum[i]);
  }
}

}  // namespace

SparseNoise make_noise(const SparseLayer& layer, std::uint64_t seed, int layer_index, const NoiseFrame& frame,
                       ArrayStore& arrays) {
  SparseNoise noise;
  noise.low = to_float(frame.domain.min);
  noise.high = to_float(frame.domain.max);
  noise.amplitude = static_cast<float>(layer.amplitude);
  (layer.merged ? noise.sum_cut : noise.level_cut) = static_cast<float>(layer.threshold);
  noise.probability = static_cast<float>(layer.probability);
  if (layer.probability > 0.0) noise.inverse_probability = static_cast<float>(1.0 / layer.probability);
  const std::uint32_t layer_seed = hash_seed(seed, static_cast<std::uint32_t>(layer_index));
  std::vector<SparseLevel> levels;
  double gains = 0.0, gain = 1.0, cell = layer.cell_size;
  for (int l = 0; l < layer.levels; ++l, gain *= layer.gain, cell *= 0.5) {
    if (!(frame.farthest() / cell <= kLargestCell)) break;
    // Cells have their centres at whole coordinates.
    const auto frequency = static_cast<float>(1.0 / cell);
    const OriginCell origin = origin_cell(double{frequency} * frame.origin);
    levels.push_back(
        {frequency, static_cast<float>(gain),
         hash_append(layer_seed, static_cast<std::uint32_t>(l)) + lattice_step(origin.x, origin.y, origin.z),
         to_float(origin.rest)});
    gains += gain;
  }
  noise.detail = {layer.cell_size * portable::whole_power(0.5, layer.levels - 1),
                  share_left_out(levels.size(), layer.levels, layer.gain)};
  noise.levels = arrays.add(levels);
  const double greatest = double{kInverseBumpHeight};
  const double deepest =
      layer.merged ? greatest * gains - layer.threshold : gains * (greatest - layer.threshold);
  noise.height_bound = std::fabs(layer.amplitude) * std::max(deepest, 0.0) * (1.0 + kSparseSlack);
  return noise;
}

void evaluate_heights(const SparseNoise& n, const ArrayView& arrays, int count, const float* x,
                      const float* y, const float* z, float* height) {
  const PointsInDomain p(n.low, n.high, count, x, y, z);
  std::fill(height, height + count, 0.0f);
  for (const SparseLevel& level : arrays.span(n.levels)) {
    add_level(n, level, count, p.x(), p.y(), p.z(), height);
  }
  for (int i = 0; i < count; ++i) height[i] = sparse_height(n.amplitude, height[i], n.sum_cut);
}

}  // namespace astrolith
