#include "synthesis/mesh/surface_probes.h"

namespace astrolith {
namespace {

// The number of blocks from two estimates. That of the sample has no bias, but scatters where it narrowed few
// squares. That along normals scatters little, but counts blocks twice where the surface is rough or folded.
double combined(double of_sample, double squares, double along_normals) {
  constexpr double kEnoughSquares = 16.0;
  if (!(along_normals > 0.0)) return of_sample;
  const double scatter = kEnoughSquares / (kEnoughSquares + squares);
  return scatter * along_normals + (1.0 - scatter) * of_sample;
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
  const double probes = double(sums.probes);
  better.triangles = surface.area() * sums.triangles_per_area / probes;
  better.vertices = 0.5 * better.triangles;
  const double along_normals = surface.area() * sums.blocks_along_normal / probes / (side * side);
  better.blocks =
      found ? combined(estimate.blocks, double(estimate.narrowed_squares), along_normals) : along_normals;
  // Blocks of the sample and of the probes count alike.
  const double sampled = found ? estimate.sampled_blocks : 0.0, meshed = double(sums.meshed_blocks);
  const double of_sample = found ? (estimate.seconds - estimate.finding_seconds) / estimate.blocks : 0.0;
  const double block_seconds =
      (sampled * of_sample + meshed * sums.seconds / sums.weights) / (sampled + meshed);
  const double ratio = found ? better.blocks / estimate.blocks : 1.0;
  better.finding_seconds = estimate.finding_seconds * ratio;
  better.seconds = better.finding_seconds + better.blocks * block_seconds;
  better.evaluations = better.blocks * sums.evaluations / sums.weights;
  better.list_bytes = sums.list_bytes / sums.weights;
  better.blocks_of_layer = better.blocks * surface.largest_share(side);
  better.blocks_of_three_layers = better.blocks * surface.largest_share(3.0 * side);
  better.caching_seconds += sums.caching_seconds;
  better.sampled_blocks += meshed;
  return better;
}

}  // namespace astrolith
