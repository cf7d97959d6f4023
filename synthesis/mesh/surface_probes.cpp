#include "synthesis/mesh/surface_probes.h"

#include <algorithm>
#include <cmath>

namespace astrolith {
namespace {

// A figure and its relative variance.
struct Figure {
  double value, variance;
};

// Two estimates of one figure, each weighted by one over its variance.
Figure mean_of_figures(const Figure& a, const Figure& b) {
  if (!(a.value > 0.0)) return b;
  if (!(b.value > 0.0)) return a;
  const double of_a = 1.0 / a.variance, of_b = 1.0 / b.variance;
  return {(of_a * a.value + of_b * b.value) / (of_a + of_b), 1.0 / (of_a + of_b)};
}

// The relative error of probes that no number of them lessens: the coarse mesh hides parts of a rough
// surface.
constexpr double kBias = 0.1;

// The number of blocks. That of the sample has no bias, but scatters at each size of squares anew, by the
// number of squares that it narrowed.
Figure number_of_blocks(const MeshEstimate& sample, const ProbedSurface& surface, const ProbeSums& sums) {
  constexpr double kOfSquare = 2.0, kOfProbe = 0.16;  // relative variances
  const double side = kBlockCells * sample.step, probes = double(sums.probes);
  return mean_of_figures(
      {sample.blocks, kOfSquare / std::max(double(sample.narrowed_squares), 1.0)},
      {surface.area() * sums.blocks_of_square / probes / (side * side), kOfProbe / probes + kBias * kBias});
}

// The number of triangles: of the coarse mesh's area, which scatters less, and of the blocks, which see what
// the coarse mesh hides.
double number_of_triangles(const MeshEstimate& sample, const ProbedSurface& surface, const ProbeSums& sums,
                           const Figure& blocks) {
  constexpr double kOfProbe = 0.05, kOfArea = 0.0025, kLeastSpread = 0.3;  // relative variances
  const double probes = double(sums.probes), meshed = double(sums.meshed_blocks);
  const double sampled = sample.blocks > 0.0 ? double(sample.sampled_blocks) : 0.0;
  const double by_area = surface.area() * sums.triangles_per_area / probes;
  if (!(sums.triangles > 0.0) || !(by_area > 0.0)) return by_area;
  const double of_block =
      (sampled * sample.triangles_per_block() + meshed * sums.triangles / sums.weights) / (sampled + meshed);
  const double spread = sums.squared_triangles * sums.weights / (sums.triangles * sums.triangles) - 1.0;
  const Figure by_blocks{blocks.value * of_block,
                         blocks.variance + std::max(spread, kLeastSpread) / (sampled + meshed)};
  return mean_of_figures({by_area, kOfProbe / probes + kOfArea}, by_blocks).value;
}

}  // namespace

MeshEstimate improved_by_probes(const MeshEstimate& estimate, const ProbedSurface& surface,
                                const ProbeSums& sums) {
  MeshEstimate better = estimate;
  better.spent_seconds += sums.spent_seconds;
  better.spent_evaluations += sums.spent_evaluations;
  if (estimate.whole || sums.probes == 0 || !(sums.weights > 0.0)) return better;
  // A thin tile of a wide grid may have all its blocks between those that the sample narrowed.
  const bool found = estimate.blocks > 0.0;
  const double side = kBlockCells * estimate.step;
  const Figure blocks = number_of_blocks(estimate, surface, sums);
  better.blocks = blocks.value;
  better.triangles = number_of_triangles(estimate, surface, sums, blocks);
  better.vertices = 0.5 * better.triangles;
  // Blocks of the sample and of the probes count alike.
  const double sampled = found ? estimate.sampled_blocks : 0.0, meshed = double(sums.meshed_blocks);
  const double of_sample = found ? (estimate.seconds - estimate.finding_seconds) / estimate.blocks : 0.0;
  const double block_seconds =
      (sampled * of_sample + meshed * sums.seconds / sums.weights) / (sampled + meshed);
  // A sample that found too few blocks has missed squares of some sizes, of others not.
  better.finding_seconds =
      estimate.finding_seconds * (found ? std::sqrt(better.blocks / estimate.blocks) : 1.0);
  better.seconds = better.finding_seconds + better.blocks * block_seconds;
  better.evaluations = better.blocks * sums.evaluations / sums.weights;
  better.list_bytes = sums.list_bytes / sums.weights;
  better.blocks_of_layer = better.blocks * surface.largest_share(side);
  better.blocks_of_three_layers = better.blocks * surface.largest_share(3.0 * side);
  better.crossed_share =
      (sampled * estimate.crossed_share + meshed * sums.crossed / sums.weights) / (sampled + meshed);
  better.caching_seconds += sums.caching_seconds;
  better.sampled_blocks += meshed;
  return better;
}

}  // namespace astrolith
