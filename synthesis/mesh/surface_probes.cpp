#include "synthesis/mesh/surface_probes.h"

#include <algorithm>
#include <cmath>

#include "numerics/portable_double.h"

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

// The relative variance of a figure that may be too low: at least `least`, and more where it lies farther
// below another one, without bias, than the variance of that tells. A coarse mesh hides parts of a rough
// surface, which no number of probes on it finds.
double variance_of_bias(double value, const Figure& without_bias, double least, double most) {
  if (!(value > 0.0) || !(without_bias.value > value)) return least;
  const double apart = portable::log(without_bias.value / value);
  return std::clamp(apart * apart - 3.0 * without_bias.variance, least, most);
}

// The number of blocks. That of the sample has no bias, but scatters at each size of squares anew, by the
// number of squares that it narrowed.
Figure number_of_blocks(const MeshEstimate& sample, const ProbedSurface& surface, const ProbeSums& sums) {
  constexpr double kOfSquare = 2.0, kOfProbe = 0.16, kOfBias = 0.01,
                   kMostOfBias = 0.04;  // relative variances
  const double side = kBlockCells * sample.step, probes = double(sums.probes);
  const Figure by_squares{sample.blocks, kOfSquare / std::max(double(sample.narrowed_squares), 1.0)};
  const double by_probes = surface.area() * sums.blocks_of_square / probes / (side * side);
  return mean_of_figures(by_squares, {by_probes, kOfProbe / probes + variance_of_bias(by_probes, by_squares,
                                                                                      kOfBias, kMostOfBias)});
}

// The number of triangles: of the coarse mesh's area, which scatters less, and of the blocks of the sample,
// which see what the coarse mesh hides.
double number_of_triangles(const MeshEstimate& sample, const ProbedSurface& surface, const ProbeSums& sums) {
  constexpr double kOfSquare = 2.0, kOfBlock = 0.3, kOfProbe = 0.05, kOfArea = 0.0025;  // relative variances
  constexpr double kMostOfArea = 0.01;  // few blocks tell little: most of them hold no triangle
  const double probes = double(sums.probes);
  const double by_area = surface.area() * sums.triangles_per_area / probes;
  if (!(sample.triangles > 0.0)) return by_area;
  const double of_blocks = (1.0 / sample.crossed_share - 1.0 + kOfBlock) / sample.sampled_blocks;
  const Figure by_blocks{sample.triangles,
                         kOfSquare / std::max(double(sample.narrowed_squares), 1.0) + of_blocks};
  return mean_of_figures(
             {by_area, kOfProbe / probes + variance_of_bias(by_area, by_blocks, kOfArea, kMostOfArea)},
             by_blocks)
      .value;
}

// A sum over some of the blocks that were meshed, and for how many blocks it stands.
struct PartialSum {
  double sum, blocks;
};

// The mean for a block of a sample and of probes. Each of their meshed blocks counts alike.
double mean_of_block(const PartialSum& of_sample, double sampled, const PartialSum& of_probes,
                     double meshed) {
  double sum = 0.0, count = 0.0;
  const auto add = [&](const PartialSum& part, double blocks) {
    if (!(part.blocks > 0.0)) return;
    sum += blocks * part.sum / part.blocks;
    count += blocks;
  };
  add(of_sample, sampled);
  add(of_probes, meshed);
  return count > 0.0 ? sum / count : 0.0;
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
  better.triangles = number_of_triangles(estimate, surface, sums);
  better.vertices = 0.5 * better.triangles;
  // Probes meet fewer of the blocks that the surface only might cross, which may lie far from it. The two
  // kinds of blocks therefore count by themselves.
  const double sampled = found ? estimate.sampled_blocks : 0.0, meshed = double(sums.meshed_blocks);
  const double of_sample = found ? estimate.seconds - estimate.finding_seconds : 0.0;
  const double crossed = estimate.blocks * estimate.crossed_share;
  const double sampled_crossed = sampled * estimate.crossed_share,
               meshed_crossed = meshed * sums.crossed / sums.weights;
  const double triangles_of_crossed = mean_of_block({estimate.triangles, crossed}, sampled_crossed,
                                                    {sums.triangles, sums.crossed}, meshed_crossed);
  const double seconds_of_crossed = mean_of_block({estimate.crossed_seconds, crossed}, sampled_crossed,
                                                  {sums.crossed_seconds, sums.crossed}, meshed_crossed);
  const double seconds_of_other = mean_of_block(
      {of_sample - estimate.crossed_seconds, estimate.blocks - crossed}, sampled - sampled_crossed,
      {sums.seconds - sums.crossed_seconds, sums.weights - sums.crossed}, meshed - meshed_crossed);
  const double number_of_crossed =
      triangles_of_crossed > 0.0 ? std::min(better.triangles / triangles_of_crossed, better.blocks) : 0.0;
  // A sample that found too few blocks has missed squares of some sizes, of others not.
  better.finding_seconds =
      estimate.finding_seconds * (found ? std::sqrt(better.blocks / estimate.blocks) : 1.0);
  better.seconds = better.finding_seconds + number_of_crossed * seconds_of_crossed +
                   (better.blocks - number_of_crossed) * seconds_of_other;
  better.crossed_share = better.blocks > 0.0 ? number_of_crossed / better.blocks : 1.0;
  better.evaluations = better.blocks * sums.evaluations / sums.weights;
  better.list_bytes = sums.list_bytes / sums.weights;
  // The coarse mesh of a folded surface lies in fewer layers than its blocks.
  const double places = estimate.places_of_layer;
  better.blocks_of_layer = std::min(better.blocks * surface.largest_share(side), places);
  better.blocks_of_three_layers = std::min(better.blocks * surface.largest_share(3.0 * side), 3.0 * places);
  better.sampled_blocks += meshed;
  better.sampled_windows += meshed + double(sums.probes);
  return better;
}

}  // namespace astrolith
