#include "estimation/shape/fit/fit_check.h"

#include "geometry/mesh_measure.h"
#include "numerics/parallel_for.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/field/implicit_field.h"

namespace astrolith {

FitCheck check_fit(const TargetBody& target, const MetaballBody& body, int resolution, std::int64_t samples,
                   std::uint64_t seed) {
  Recipe recipe;
  recipe.body = body;
  const ImplicitField field(recipe);
  MeshCollector collector;
  mesh_field(field, field.bounds(), resolution, collector);
  FitCheck check{std::move(collector.mesh), {}, {}, 0.0};
  check.topology = analyze_topology(check.mesh);
  check.distance =
      surface_distance(target.surface, target.tree, check.mesh, SurfaceTree(check.mesh), samples, seed);
  check.volume_ratio = volume(check.mesh) / target.volume;
  return check;
}

FitPoints stray_points(const TargetBody& target, const TriangleMesh& mesh, double threshold) {
  std::vector<double> distances(mesh.vertices.size());
  parallel_for(
      0, static_cast<std::int64_t>(distances.size()),
      [&](std::int64_t i) {
        distances[static_cast<std::size_t>(i)] =
            target.tree.signed_distance(mesh.vertices[static_cast<std::size_t>(i)]);
      },
      64);
  FitPoints strays;
  for (std::size_t i = 0; i < distances.size(); ++i) {
    if (distances[i] > threshold) strays.inside.push_back(mesh.vertices[i]);
    if (distances[i] < -threshold) strays.outside.push_back(mesh.vertices[i]);
  }
  return strays;
}

}  // namespace astrolith
