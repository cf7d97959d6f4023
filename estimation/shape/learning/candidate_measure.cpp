#include "estimation/shape/learning/candidate_measure.h"

#include <algorithm>
#include <cmath>

#include "descriptor/histogram_distance.h"
#include "descriptor/shape_description.h"
#include "descriptor/surface/realism.h"
#include "geometry/mesh_topology.h"
#include "numerics/portable_double.h"
#include "numerics/reported_loop.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/field/implicit_field.h"

namespace astrolith {
namespace {

constexpr std::int64_t kHistogramPoints = 4000;
// Marching cubes need twice the triangles to show what the target's mesh shows.
constexpr double kTrianglesPerPoint = 4.0;

// A weight for a statistic in the search, or 0.
double search_weight(const StatisticComparison& c) {
  constexpr double kOfCoarse = 0.5;
  if (c.correlation) return kOfCoarse;
  const bool seen = c.quantity == SurfaceQuantity::roughness || c.quantity == SurfaceQuantity::skewness ||
                    c.quantity == SurfaceQuantity::normals;
  if (!seen) return 0.0;
  return c.counts_in_distance ? 1.0 : kOfCoarse;
}

double held_out_weight(const StatisticComparison& c) {
  return !c.correlation && c.quantity == SurfaceQuantity::kurtosis ? 1.0 : 0.0;
}

// The ratio of variances as a distance: .05 for a factor of 1.4.
double ratio_distance(double ratio) {
  constexpr double kPerLogarithm = 0.15;
  return kPerLogarithm * std::fabs(portable::log(std::clamp(ratio, 1e-2, 1e2)));
}

// What a candidate has beyond what it should: .01 for one, no more than .1.
double excess_penalty(std::int64_t excess) {
  return std::min(0.01 * static_cast<double>(std::max<std::int64_t>(excess, 0)), 0.1);
}

double middle_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double mean_skewness(const SurfaceStatistics& statistics) {
  double sum = 0.0, count = 0.0;
  for (const double radius : {3.0, 6.0}) {
    const LocalStatistic* skewness = statistics.find(SurfaceQuantity::skewness, radius);
    if (skewness == nullptr) continue;
    for (const double value : skewness->values) sum += value;
    count += static_cast<double>(skewness->values.size());
  }
  return count > 0.0 ? sum / count : 0.0;
}

void add_distances(const SurfaceStatistics& wanted, const SurfaceStatistics& found,
                   CandidateFigures& figures) {
  double squares = 0.0, weights = 0.0, largest = 0.0, held_out = 0.0, held_out_weights = 0.0;
  const auto add = [&](double distance, double weight) {
    squares += weight * distance * distance;
    weights += weight;
    largest = std::max(largest, weight * distance * distance);
  };
  // Correlations differ by a few tenths from draw to draw of one recipe, other statistics by a few
  // hundredths.
  constexpr double kOfCorrelation = 0.25;
  for (const StatisticComparison& c : statistic_distances(wanted, found)) {
    add((c.correlation ? kOfCorrelation : 1.0) * c.distance, search_weight(c));
    held_out += held_out_weight(c) * c.distance;
    held_out_weights += held_out_weight(c);
  }
  if (wanted.regions.between > 0.0) {
    figures.variance_ratio = found.regions.between / wanted.regions.between;
    add(ratio_distance(figures.variance_ratio), 1.0);
  }
  figures.distance = std::sqrt(squares / weights + 0.5 * largest);
  figures.held_out = held_out / std::max(held_out_weights, 1.0);
}

int resolution_for(const Recipe& recipe, double triangles, const Progress& progress) {
  constexpr int kFirst = 64, kLeast = 16, kMost = 1024;
  const ImplicitField field(recipe);
  MeshCollector collector;
  mesh_field(field, field.bounds(), kFirst, collector, at_beginning(progress));
  const auto of_first = static_cast<double>(std::max<std::size_t>(collector.mesh.triangles.size(), 1));
  return std::clamp(static_cast<int>(std::lround(kFirst * std::sqrt(triangles / of_first))), kLeast, kMost);
}

}  // namespace

CandidateMeasure::CandidateMeasure(const TargetBody& target, const Recipe& base,
                                   const CandidateOptions& options, const Progress& progress)
    : target_(target), base_(base), options_(options) {
  base_.layers.clear();
  wanted_ = statistics_of(target.surface, options.seed, progress);
  const MeshTopology topology = analyze_topology(target.surface);
  wanted_genus_ = std::max<std::int64_t>(topology.genus, 0);
  resolution_ = resolution_for(base_, kTrianglesPerPoint * static_cast<double>(wanted_.points), progress);
}

TriangleMesh CandidateMeasure::mesh_of(const Recipe& recipe, const Progress& progress) const {
  const ImplicitField field(recipe);
  MeshCollector collector;
  mesh_field(field, field.bounds(), resolution_, collector, at_beginning(progress));
  for (Vec3d& p : collector.mesh.vertices) p = (p - target_.center) * (1.0 / target_.diagonal);
  return std::move(collector.mesh);
}

SurfaceStatistics CandidateMeasure::statistics_of(const TriangleMesh& mesh, std::uint64_t seed,
                                                  const Progress& progress) const {
  SurfaceStatisticsOptions options;
  options.points = std::min(own_points(target_.surface), options_.most_points);
  options.places = options_.places;
  options.radii = {3, 6, 12};
  options.slopes = false;
  options.seed = seed;
  return surface_statistics(mesh, options, at_beginning(progress));
}

double CandidateMeasure::similarity_with(const TriangleMesh& mesh, int draw, const Progress& progress) const {
  const auto histogram = [&](const TriangleMesh& of, std::uint64_t which) {
    DescriptionOptions options;
    options.points = kHistogramPoints;
    options.seed = 3 * (options_.seed + static_cast<std::uint64_t>(draw)) + which;
    return describe_shape(of, options, at_beginning(progress)).histogram;
  };
  return astrolith::similarity(histogram(target_.surface, 0), histogram(mesh, 1));
}

CandidateFigures CandidateMeasure::figures(const std::vector<Layer>& layers, int draw, bool with_similarity,
                                           const Progress& progress) const {
  Recipe recipe = base_;
  recipe.layers = layers;
  recipe.seed += static_cast<std::uint64_t>(draw);
  const TriangleMesh mesh = mesh_of(recipe, progress);
  const SurfaceStatistics found =
      statistics_of(mesh, options_.seed + 3 * static_cast<std::uint64_t>(draw + 1), progress);
  CandidateFigures figures;
  add_distances(wanted_, found, figures);
  for (const LocalStatistic& of_target : wanted_.local) {
    if (of_target.quantity != SurfaceQuantity::roughness) continue;
    const LocalStatistic* of_found = found.find(of_target.quantity, of_target.radius);
    if (of_found == nullptr) continue;
    figures.rougher[of_target.radius] = middle_of(of_found->values) - middle_of(of_target.values);
  }
  figures.skewness_lack = mean_skewness(wanted_) - mean_skewness(found);
  const MeshTopology topology = analyze_topology(mesh);
  figures.components = topology.components;
  figures.genus = topology.genus;
  figures.distance += excess_penalty(topology.components - target_.components) +
                      excess_penalty((topology.genus - wanted_genus_) / 4);
  if (with_similarity) figures.similarity = similarity_with(mesh, draw, progress);
  return figures;
}

}  // namespace astrolith
