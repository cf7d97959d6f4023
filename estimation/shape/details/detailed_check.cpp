#include "estimation/shape/details/detailed_check.h"

#include "synthesis/field/field_mesh.h"
#include "synthesis/field/implicit_field.h"

namespace astrolith {
namespace {

TriangleMesh mesh_in_target_frame(const TargetBody& target, const Recipe& recipe, int resolution) {
  const ImplicitField field(recipe);
  MeshCollector collector;
  mesh_field(field, field.bounds(), resolution, collector);
  for (Vec3d& p : collector.mesh.vertices) p = (p - target.center) * (1.0 / target.diagonal);
  return std::move(collector.mesh);
}

}  // namespace

FitCheck check_recipe(const TargetBody& target, const Recipe& recipe, int resolution, std::int64_t samples,
                      std::uint64_t seed) {
  return check_mesh(target, mesh_in_target_frame(target, recipe, resolution), samples, seed);
}

}  // namespace astrolith
