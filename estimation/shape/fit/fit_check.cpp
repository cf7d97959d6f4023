#include "estimation/shape/fit/fit_check.h"

#include "geometry/mesh_measure.h"
#include "geometry/mesh_normals.h"
#include "numerics/parallel_for.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/field/implicit_field.h"

namespace astrolith {

FitCheck check_mesh(const TargetBody& target, TriangleMesh mesh, std::int64_t samples, std::uint64_t seed) {
  FitCheck check{std::move(mesh), {}, {}, 0.0};
  check.topology = analyze_topology(check.mesh);
  check.distance =
      surface_distance(target.surface, target.tree, check.mesh, SurfaceTree(check.mesh), samples, seed);
  check.volume_ratio = volume(check.mesh) / target.volume;
  return check;
}

FitCheck check_fit(const TargetBody& target, const MetaballBody& body, int resolution, std::int64_t samples,
                   std::uint64_t seed) {
  Recipe recipe;
  recipe.body = body;
  const ImplicitField field(recipe);
  MeshCollector collector;
  mesh_field(field, field.bounds(), resolution, collector);
  return check_mesh(target, std::move(collector.mesh), samples, seed);
}

FitPoints stray_points(const TargetBody& target, const TriangleMesh& mesh, double threshold, double turned) {
  constexpr double kTurned = 0.5;  // largest cosine between the normals
  const std::vector<Vec3d> normals = vertex_normals(mesh);
  std::vector<double> strays(mesh.vertices.size(), 0.0);  // signed distances of strays, else 0
  parallel_for(
      0, static_cast<std::int64_t>(strays.size()),
      [&](std::int64_t i) {
        const auto v = static_cast<std::size_t>(i);
        const ClosestPoint closest = target.tree.closest(mesh.vertices[v]);
        const bool far = closest.distance > threshold;
        if (far || (closest.distance > turned && dot(normals[v], closest.normal) < kTurned))
          strays[v] = target.tree.signed_distance(mesh.vertices[v]);
      },
      64);
  FitPoints points;
  for (std::size_t v = 0; v < strays.size(); ++v) {
    if (strays[v] > 0.0) points.inside.push_back(mesh.vertices[v]);
    if (strays[v] < 0.0) points.outside.push_back(mesh.vertices[v]);
  }
  return points;
}

}  // namespace astrolith
