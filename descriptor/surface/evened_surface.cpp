#include "descriptor/surface/evened_surface.h"

#include <algorithm>
#include <cmath>

#include "descriptor/histogram_distance.h"
#include "geometry/mesh_measure.h"
#include "geometry/points/point_tree_internal.h"
#include "geometry/surface/mesh_sampling.h"
#include "numerics/errors.h"
#include "numerics/reported_loop.h"

namespace astrolith {
namespace {

constexpr std::int64_t kSamplesPerPoint = 5;
constexpr double kReach = 3.5, kBendReach = 0.5;  // edges

struct Smoothed {
  double height = 0.0;  // along the normal
  Vec3d normal;
  double bend = 0.0;
  Vec3d mean;
};

// The weighted mean of the normals, and of the heights over the plane across it.
Smoothed smoothed(const Vec3d& point, const Vec3d& own_normal, double reach, const PointTree& tree,
                  const SurfaceSamples& samples) {
  constexpr double kNear = kBendReach * kBendReach / (kReach * kReach);
  constexpr double kFine = kReach * kReach / (kMeanReach * kMeanReach);
  double weights = 0.0, near = 0.0, fine_squares = 0.0, fine_weights = 0.0;
  Vec3d normals{}, offsets{}, near_normals{}, fine_offsets{};
  for (const auto& [j, squared] : tree.within(point, reach)) {
    if (dot(samples.normals[j], own_normal) <= 0.0) continue;
    const double x = std::max(0.0, 1.0 - squared / (reach * reach)), w = x * x * x;
    weights += w;
    normals += w * samples.normals[j];
    offsets += w * (samples.points[j] - point);
    const double fine = std::max(0.0, 1.0 - kFine * squared / (reach * reach));
    fine_squares += fine * squared;
    fine_weights += fine;
    fine_offsets += fine * (samples.points[j] - point);
    if (squared > kNear * reach * reach) continue;
    near += 1.0;
    near_normals += samples.normals[j];
  }
  if (!(weights > 0.0) || !(squared_norm(normals) > 0.0)) return {0.0, own_normal, 0.0, point};
  const Vec3d normal = normalized(normals);
  // The mean squared chord of unit vectors from the direction of their sum s is 2 - 2 |s| / n. Rounding
  // leaves some 1e-16 of a flat facet.
  const double chord = near > 0.0 ? 2.0 - 2.0 * norm(near_normals) / near : 0.0;
  const double bend = chord > 1e-10 ? std::sqrt(chord) : 0.0;
  const double mean_square = kMeanSquare * reach * reach / (kReach * kReach);
  // Where samples lie near the point only, no more than twice their mean offset.
  const double fine_factor =
      fine_weights > 0.0 ? std::min(mean_square / fine_squares, 2.0 / fine_weights) : 0.0;
  const Vec3d mean = point + fine_factor * fine_offsets;
  return {dot(offsets, normal) / weights, normal, bend, mean};
}

// A plane has some 220 samples within the reach, and the roughest of measured surfaces some 300. Where a body
// has 4,000, its facets lie through one another.
constexpr double kMostWithinReach = 4000.0;

void require_surface(const SurfaceSamples& samples, const PointTree& tree, double reach) {
  constexpr std::size_t kPlaces = 64;
  double found = 0.0;
  for (std::size_t k = 0; k < kPlaces; ++k) {
    const std::size_t place = k * samples.points.size() / kPlaces;
    found += static_cast<double>(tree.within(samples.points[place], reach).size());
  }
  if (found <= kMostWithinReach * kPlaces) return;
  throw InputError(
      "surface statistics: the mesh passes through itself everywhere, its area is many times what its box "
      "holds; vertices or faces are garbled: repair the file");
}

}  // namespace

ShapeDescription describe_evened(const TriangleMesh& mesh, const DescriptionOptions& options,
                                 const StageProgress& progress) {
  const auto stage = [&](const char* name) { return progress ? progress(name) : Progress(); };
  const EvenedSurface even = even_surface(mesh, options.points, options.seed, stage("even"));
  return describe_shape(even.points, even.normals, options, stage("describe"));
}

DescriptionOptions for_sampling(DescriptionOptions options, std::uint64_t which) {
  options.seed += which * 0x9e3779b97f4a7c15u;
  return options;
}

MeasuredSimilarity measure_similarity(const TriangleMesh& target, const TriangleMesh& candidate,
                                      std::uint64_t seed, const StageProgress& progress) {
  DescriptionOptions options;
  options.seed = seed;
  const auto histogram = [&](const TriangleMesh& mesh, std::uint64_t which) {
    return describe_evened(mesh, for_sampling(options, which), progress).histogram;
  };
  const ShapeHistogram wanted = histogram(target, 0);
  return {similarity(wanted, histogram(candidate, 1)), similarity(wanted, histogram(target, 2))};
}

double evened_edge(double area, std::int64_t n) {
  return std::sqrt(2.0 * area / (std::sqrt(3.0) * static_cast<double>(n)));
}

EvenedSurface even_surface(const TriangleMesh& mesh, std::int64_t n, std::uint64_t seed,
                           const Progress& progress) {
  const SurfaceSamples samples =
      sample_surface(mesh, kSamplesPerPoint * n, seed + 1, SampleNormals::triangle, at_beginning(progress));
  const PointTree tree(samples.points);
  const double area = surface_area(mesh), edge = evened_edge(area, n);
  require_surface(samples, tree, kReach * edge);
  SurfaceSamples points = sample_poisson_disk(mesh, n, seed, SampleNormals::triangle, at_beginning(progress));
  EvenedSurface even{std::move(points.points), std::move(points.normals), {}, {}, area, edge};
  even.bends.resize(even.points.size());
  even.means.resize(even.points.size());
  reported_parallel_for({0, n, n}, at_beginning(progress), "evening", [&](std::int64_t index) {
    const auto i = static_cast<std::size_t>(index);
    const Smoothed s = smoothed(even.points[i], even.normals[i], kReach * even.edge, tree, samples);
    even.points[i] += s.height * s.normal;
    even.normals[i] = s.normal;
    even.bends[i] = s.bend;
    even.means[i] = s.mean;
  });
  return even;
}

}  // namespace astrolith
