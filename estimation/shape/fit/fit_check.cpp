#include "estimation/shape/fit/fit_check.h"

#include <algorithm>

#include "geometry/mesh_measure.h"
#include "numerics/parallel_for.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/field/implicit_field.h"

namespace astrolith {
namespace {

// Points on each side of the surface: their number and their least distance from the surface.
constexpr int kContainmentPoints = 2000;
constexpr double kContainmentDepth = 0.015;  // fraction of the diagonal

// Shells of points on both sides of the surface, at these distances from it (fractions of the diagonal). No
// island with a size of a few hundredths fits between two shells.
constexpr double kShells[] = {0.008, 0.016, 0.032};
constexpr double kShellShare = 0.25;  // points in a shell, as a share of the surface samples

}  // namespace

FitPoints containment_points(const TargetBody& target, const ContainmentOptions& options) {
  FitPoints points;
  add_containment_points(target, std::min(kContainmentDepth, 0.5 * options.deepest), kContainmentPoints,
                         options.seed, points);
  const auto in_shell = static_cast<int>(kShellShare * static_cast<double>(options.samples));
  for (const double distance : kShells) {
    add_shell_points(target, distance, in_shell, options.shell_seed, points);
  }
  add_middle_points(target, kShells[0], in_shell, options.shell_seed, points);
  return points;
}

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
