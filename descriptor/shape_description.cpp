#include "descriptor/shape_description.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "descriptor/local_features.h"
#include "descriptor/surflet_histogram.h"
#include "geometry/surface/mesh_sampling.h"
#include "geometry/surface/sample_curvature.h"
#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "numerics/reported_loop.h"

namespace astrolith {
namespace {

// The radius of the balls in which curvature is averaged, as a fraction of the root mean square distance from
// the centre. Craters and boulders of this size shape kappa; smaller ones are averaged out. A smaller radius
// tells bodies apart better, but also tells a body from its own coarser mesh. This radius is two edges of a
// mesh of 3,000 triangles, so that most meshes of a body give nearly the same kappa.
constexpr double kCurvatureRadius = 0.2;

void check(const DescriptionOptions& options) {
  if (options.points < 2 || options.points > (std::int64_t{1} << 24)) {
    throw InputError("description: " + std::to_string(options.points) +
                     " points are outside 2 to 16777216; 10000 is usual");
  }
}

void add_curvature(const SurfaceSamples& s, const SampleCurvature& curvature,
                   const DescriptionOptions& options, const Progress& progress, ShapeDescription& result) {
  result.histogram =
      ahd_histogram(s.points, s.normals, curvature.gaussian, options.bins, progress, options.count_pairs);
  result.vertices_left_out = curvature.vertices_left_out;
  result.undefined_curvatures = curvature.undefined;
  if (curvature.vertices_left_out > 0) {
    result.remarks.push_back(std::to_string(curvature.vertices_left_out) +
                             " vertices (open, non-manifold or unused) have no curvature and were left out");
  }
  if (curvature.undefined > 0) {
    result.remarks.push_back(std::to_string(curvature.undefined) +
                             " points have no curvature around them and count as flat");
  }
}

// The numbers of the points that no earlier point repeats, ascending.
std::vector<std::size_t> distinct(std::span<const Vec3d> points) {
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto place = [&](std::size_t i) { return std::tuple(points[i].x, points[i].y, points[i].z); };
  std::stable_sort(order.begin(), order.end(), [&](auto i, auto j) { return place(i) < place(j); });
  order.erase(std::unique(order.begin(), order.end(), [&](auto i, auto j) { return place(i) == place(j); }),
              order.end());
  std::sort(order.begin(), order.end());
  return order;
}

// `count` of the numbers, chosen with equal chances, ascending.
std::vector<std::size_t> chosen(std::vector<std::size_t> from, std::size_t count, std::uint64_t seed) {
  for (std::size_t k = 0; k < count; ++k) {
    std::swap(from[k], from[k + CounterRandom(seed, k).below(from.size() - k)]);
  }
  from.resize(count);
  std::sort(from.begin(), from.end());
  return from;
}

void check_points(std::span<const Vec3d> points, std::span<const Vec3d> normals) {
  if (points.size() != normals.size()) {
    throw InputError("description: " + std::to_string(points.size()) + " points have " +
                     std::to_string(normals.size()) + " normals; give one for each");
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!std::isfinite(squared_norm(points[i])) || !(squared_norm(normals[i]) > 0) ||
        !std::isfinite(squared_norm(normals[i]))) {
      throw InputError("description: point " + std::to_string(i) +
                       " or its normal is not finite, or the normal has no length; leave it out");
    }
  }
}

SurfaceSamples select(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                      const DescriptionOptions& options, std::vector<std::string>& remarks) {
  std::vector<std::size_t> which = distinct(points);
  if (which.size() < points.size()) {
    remarks.push_back(std::to_string(points.size() - which.size()) + " repeated points were left out");
  }
  if (which.size() < 2) throw InputError("description: fewer than two distinct points; give more");
  const auto wanted = static_cast<std::size_t>(options.points);
  if (which.size() < wanted) {
    remarks.push_back("only " + std::to_string(which.size()) + " points, " + std::to_string(wanted) +
                      " were asked for");
  } else {
    which = chosen(std::move(which), wanted, options.seed);
  }
  SurfaceSamples s;
  for (const std::size_t i : which) {
    s.points.push_back(points[i]);
    s.normals.push_back(normalized(normals[i]));
  }
  return s;
}

}  // namespace

ShapeDescription describe_shape(const TriangleMesh& mesh, const DescriptionOptions& options,
                                const Progress& progress) {
  check(options);
  ShapeDescription result;
  const SurfaceSamples s = sample_poisson_disk(mesh, options.points, options.seed, SampleNormals::triangle,
                                               at_beginning(progress));
  result.points = static_cast<std::int64_t>(s.points.size());
  if (options.features == PairFeatures::wahl) {
    result.histogram = surflet_histogram(s.points, s.normals, options.bins, progress, options.count_pairs);
  } else {
    const double radius = kCurvatureRadius * std::sqrt(point_spread(s.points).mean_square);
    add_curvature(s, sample_curvature(mesh, s, radius, at_beginning(progress)), options, progress, result);
  }
  return result;
}

ShapeDescription describe_shape(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                                const DescriptionOptions& options, const Progress& progress) {
  check(options);
  check_points(points, normals);
  ShapeDescription result;
  const SurfaceSamples s = select(points, normals, options, result.remarks);
  result.points = static_cast<std::int64_t>(s.points.size());
  if (options.features == PairFeatures::wahl) {
    result.histogram = surflet_histogram(s.points, s.normals, options.bins, progress, options.count_pairs);
  } else {
    add_curvature(s, point_curvature(s.points, s.normals, kCurvatureNeighbours, at_beginning(progress)),
                  options, progress, result);
  }
  return result;
}

}  // namespace astrolith
