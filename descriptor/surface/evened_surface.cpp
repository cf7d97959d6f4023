#include "descriptor/surface/evened_surface.h"

#include <cmath>

#include "geometry/mesh_measure.h"
#include "geometry/points/point_tree_internal.h"
#include "geometry/surface/mesh_sampling.h"
#include "numerics/reported_loop.h"

namespace astrolith {
namespace {

constexpr std::int64_t kSamplesPerPoint = 8;
constexpr double kReach = 2.5;  // edges

struct Smoothed {
  double height = 0.0;  // along the normal
  Vec3d normal;
};

// The weighted mean of the normals, and of the heights over the plane across it.
Smoothed smoothed(const Vec3d& point, const Vec3d& own_normal, double reach, const PointTree& tree,
                  const SurfaceSamples& samples) {
  double weights = 0.0;
  Vec3d normals{}, offsets{};
  for (const auto& [j, squared] : tree.within(point, reach)) {
    if (dot(samples.normals[j], own_normal) <= 0.0) continue;
    const double x = std::max(0.0, 1.0 - squared / (reach * reach)), w = x * x * x;
    weights += w;
    normals += w * samples.normals[j];
    offsets += w * (samples.points[j] - point);
  }
  if (!(weights > 0.0) || !(squared_norm(normals) > 0.0)) return {0.0, own_normal};
  const Vec3d normal = normalized(normals);
  return {dot(offsets, normal) / weights, normal};
}

}  // namespace

double evened_edge(double area, std::int64_t n) {
  return std::sqrt(2.0 * area / (std::sqrt(3.0) * static_cast<double>(n)));
}

EvenedSurface even_surface(const TriangleMesh& mesh, std::int64_t n, std::uint64_t seed,
                           const Progress& progress) {
  SurfaceSamples points = sample_poisson_disk(mesh, n, seed, SampleNormals::triangle, at_beginning(progress));
  const SurfaceSamples samples =
      sample_surface(mesh, kSamplesPerPoint * n, seed + 1, SampleNormals::triangle, at_beginning(progress));
  EvenedSurface even{std::move(points.points), std::move(points.normals), surface_area(mesh), 0.0};
  even.edge = evened_edge(even.area, n);
  const PointTree tree(samples.points);
  reported_parallel_for({0, n, n}, at_beginning(progress), "evening", [&](std::int64_t index) {
    const auto i = static_cast<std::size_t>(index);
    const Smoothed s = smoothed(even.points[i], even.normals[i], kReach * even.edge, tree, samples);
    even.points[i] += s.height * s.normal;
    even.normals[i] = s.normal;
  });
  return even;
}

}  // namespace astrolith
