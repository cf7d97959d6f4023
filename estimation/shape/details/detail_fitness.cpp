#include "estimation/shape/details/detail_fitness.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "descriptor/histogram_distance.h"
#include "descriptor/local_features.h"
#include "descriptor/surflet_histogram.h"
#include "geometry/mesh_measure.h"
#include "geometry/surface/sample_curvature.h"
#include "numerics/parallel_for.h"
#include "numerics/sample_statistics.h"

namespace astrolith {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

Vec3d facet(const std::vector<Vec3d>& vertices, const Triangle& t) {
  return cross(vertices[t[1]] - vertices[t[0]], vertices[t[2]] - vertices[t[0]]);
}

double angle_between(const Vec3d& a, const Vec3d& b) { return std::atan2(norm(cross(a, b)), dot(a, b)); }

// The integral of the curvature around every vertex, 2 pi minus the sum of its angles, and the area around
// it, a third of its triangles. Meyer et al. divide the area among the vertices a little differently (mixed
// areas). A mean over many vertices does not show the difference.
struct VertexIntegrals {
  std::vector<double> curvature, area;
};

VertexIntegrals vertex_integrals(const std::vector<Vec3d>& vertices, const std::vector<Triangle>& triangles) {
  VertexIntegrals result{std::vector<double>(vertices.size(), kTwoPi),
                         std::vector<double>(vertices.size(), 0.0)};
  for (const Triangle& t : triangles) {
    const double third = norm(facet(vertices, t)) / 6.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d& here = vertices[t[k]];
      const Vec3d next = vertices[t[(k + 1) % 3]] - here, previous = vertices[t[(k + 2) % 3]] - here;
      result.curvature[t[k]] -= angle_between(next, previous);
      result.area[t[k]] += third;
    }
  }
  return result;
}

// Heights lie within this distance of the base (fraction of the diagonal).
constexpr double kHeightReach = 0.05;

// A line with a height above this multiple of the median is left out: such a height is an error of the base
// and not a detail.
constexpr double kStrayLine = 8.0;

// The range of amplitudes, as multiples of the residual's root mean square.
constexpr double kLeastAmplitude = 0.02, kLargestAmplitude = 20.0;
constexpr double kTiniestAmplitude = 1e-7;  // fraction of the diagonal; a float resolves no less

// The curvature radius of descriptor/shape_description.h.
constexpr double kCurvatureRadius = 0.2;

double root_mean_square(std::span<const double> values) {
  double sum = 0.0;
  for (const double v : values) sum += v * v;
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(values.size(), 1)));
}

double curvature_radius(const SurfaceSamples& samples) {
  return kCurvatureRadius * std::sqrt(point_spread(samples.points).mean_square);
}

ShapeHistogram curvature_histogram(const TriangleMesh& mesh, const SurfaceSamples& samples) {
  const SampleCurvature curvature = sample_curvature(mesh, samples, curvature_radius(samples));
  return ahd_histogram(samples.points, samples.normals, curvature.gaussian);
}

std::vector<MeshPlace> nearest_places(const TriangleMesh& mesh, const std::vector<Vec3d>& points) {
  const SurfaceTree tree(mesh);
  std::vector<MeshPlace> places;
  for (const Vec3d& p : points) places.push_back(nearest_place(mesh, tree, p));
  return places;
}

// The wavelength of the first octave is at most twice the longest lag. The wavelength of every octave is at
// least two edges.
DetailRanges detail_ranges(const std::vector<double>& lags, double edge, double residual) {
  DetailRanges ranges;
  ranges.highest_frequency = 0.5 / edge;
  ranges.lowest_frequency = std::min(0.5 / lags.back(), 0.5 * ranges.highest_frequency);
  ranges.least_amplitude = std::max(kLeastAmplitude * residual, kTiniestAmplitude);
  ranges.largest_amplitude = std::max(kLargestAmplitude * residual, 2.0 * ranges.least_amplitude);
  return ranges;
}

}  // namespace

MovedMesh::MovedMesh(const TriangleMesh& mesh, const std::vector<MeshPlace>& samples, double radius)
    : triangles_(mesh.triangles), samples_(samples) {
  const std::vector<Vec3d> normals = vertex_normals(mesh);
  for (const MeshPlace& sample : samples_) add_neighbours(mesh, normals, sample, radius);
}

void MovedMesh::add_neighbours(const TriangleMesh& mesh, const std::vector<Vec3d>& normals,
                               const MeshPlace& sample, double radius) {
  const Triangle& t = triangles_[sample.triangle];
  const Vec3d point = sample.interpolate(triangles_, mesh.vertices), normal = facet(mesh.vertices, t);
  double reach = radius;
  for (const std::uint32_t v : t) reach = std::max(reach, norm(mesh.vertices[v] - point));
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    const double closeness = 1.0 - squared_norm(mesh.vertices[v] - point) / (reach * reach);
    if (closeness <= 0.0 || dot(normals[v], normal) <= 0.0) continue;
    neighbours_.push_back({v, static_cast<float>(closeness * closeness)});
  }
  first_neighbour_.push_back(neighbours_.size());
}

PairInput MovedMesh::pair_input(const std::vector<Vec3d>& vertices) const {
  const VertexIntegrals integrals = vertex_integrals(vertices, triangles_);
  std::vector<Vec3d> points, normals;
  std::vector<double> curvatures;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    points.push_back(samples_[i].interpolate(triangles_, vertices));
    normals.push_back(facet(vertices, triangles_[samples_[i].triangle]));
    double curvature = 0.0, area = 0.0;
    for (std::size_t k = first_neighbour_[i]; k < first_neighbour_[i + 1]; ++k) {
      const double weight = double{neighbours_[k].weight};
      curvature += weight * integrals.curvature[neighbours_[k].vertex];
      area += weight * integrals.area[neighbours_[k].vertex];
    }
    curvatures.push_back(area > 0.0 ? curvature / area : 0.0);
  }
  return ahd_input(points, normals, curvatures);
}

ShapeHistogram MovedMesh::histogram(const std::vector<Vec3d>& vertices) const {
  const PairInput input = pair_input(vertices);
  return ahd_histogram(
      input, count_pairs(input.points, input.normals, input.local, input.num_local, input.bins, {}));
}

DetailFitness::DetailFitness(const TargetBody& target, const MetaballBody& base,
                             const FitnessOptions& options)
    : options_(options),
      layout_(lay_out_probes(target, base, options.lines, options.seed)),
      probe_(base, layout_.vertex_points(), kHeightReach),
      samples_(sample_poisson_disk(target.surface, options.samples, options.seed)),
      mesh_(layout_.mesh, nearest_places(layout_.mesh, samples_.points), curvature_radius(samples_)),
      wanted_histogram_(curvature_histogram(target.surface, samples_)) {
  std::vector<double> heights = target_heights(target.tree, layout_.place_points(), kHeightReach);
  // The facets of a target that is finer than the base's mesh are steeper than that mesh can reproduce. The
  // mesh is then moved to the target, and both histogram and heights are taken from it.
  if (facet_edge(target) < 0.9 * probe_edge(target)) {
    const std::vector<double> vertex_heights =
        target_heights(target.tree, layout_.vertex_points(), kHeightReach);
    wanted_histogram_ = histogram(vertex_heights);
    heights = layout_.at_places(vertex_heights);
  }
  leave_out_strays(heights);
  wanted_roughness_ = roughness(heights, layout_.triples);
  // The roughness has the size of the residual and does not include strays.
  ranges_ = detail_ranges(layout_.lags, probe_edge(target), root_mean_square(wanted_roughness_));
}

DetailScore DetailFitness::score(std::span<const FractalLayer> layers) const {
  const std::vector<double> heights = probe_.heights(layers, options_.recipe_seed);
  return detail_score(histogram(heights), heights, layers);
}

std::vector<DetailScore> DetailFitness::scores(std::span<const std::vector<FractalLayer>> candidates,
                                               CandidateEvaluator& evaluator) const {
  const auto heights = probe_.heights(evaluator, candidates, options_.recipe_seed);
  const std::size_t n = candidates.size();
  std::vector<PairInput> inputs(n);
  std::vector<std::optional<SurfletArrays>> arrays(n);
  parallel_for(0, static_cast<std::int64_t>(n), [&](std::int64_t i) {
    PairInput& input = inputs[static_cast<std::size_t>(i)];
    input = mesh_.pair_input(moved_vertices(heights[static_cast<std::size_t>(i)]));
    arrays[static_cast<std::size_t>(i)].emplace(input.points, input.normals, input.local, input.num_local);
  });
  std::vector<SurfletArrays> sets;
  for (auto& array : arrays) sets.push_back(std::move(*array));
  const auto counts = evaluator.count(sets, kDefaultBins);
  std::vector<DetailScore> scores;
  for (std::size_t i = 0; i < n; ++i) {
    scores.push_back(detail_score(ahd_histogram(inputs[i], counts[i]), heights[i], candidates[i]));
  }
  return scores;
}

DetailScore DetailFitness::detail_score(const ShapeHistogram& histogram, const std::vector<double>& heights,
                                        std::span<const FractalLayer> layers) const {
  return {similarity(wanted_histogram_, histogram),
          roughness_misfit(roughness(layout_.at_places(heights), layout_.triples), wanted_roughness_),
          steepness(layers)};
}

std::vector<double> DetailFitness::layers_roughness(std::span<const FractalLayer> layers) const {
  return roughness(layout_.at_places(probe_.heights(layers, options_.recipe_seed)), layout_.triples);
}

void DetailFitness::leave_out_strays(const std::vector<double>& heights) {
  const double most = std::max(kStrayLine * median_magnitude(heights), kTiniestAmplitude);
  for (std::vector<HeightTriple>& triples : layout_.triples) {
    std::erase_if(triples, [&](const HeightTriple& t) {
      return std::max({std::fabs(heights[t.before]), std::fabs(heights[t.middle]),
                       std::fabs(heights[t.after])}) > most;
    });
  }
}

std::vector<Vec3d> DetailFitness::moved_vertices(const std::vector<double>& heights) const {
  const TriangleMesh& mesh = layout_.mesh;
  std::vector<Vec3d> vertices;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    vertices.push_back(mesh.vertices[v] + heights[v] * mesh.normals[v]);
  }
  return vertices;
}

ShapeHistogram DetailFitness::histogram(const std::vector<double>& heights) const {
  return mesh_.histogram(moved_vertices(heights));
}

}  // namespace astrolith
