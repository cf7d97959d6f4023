#include "estimation/shape/details/detailed_check.h"

#include "descriptor/histogram_distance.h"
#include "descriptor/shape_description.h"
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

MeasuredSimilarity measure_similarity(const TriangleMesh& target, const TriangleMesh& candidate,
                                      PairFeatures features, std::int64_t points, std::uint64_t seed) {
  const auto histogram = [&](const TriangleMesh& mesh, std::uint64_t which) {
    DescriptionOptions options;
    options.features = features;
    options.points = points;
    options.seed = 3 * seed + which;
    return describe_shape(mesh, options).histogram;
  };
  const ShapeHistogram wanted = histogram(target, 0);
  return {similarity(wanted, histogram(candidate, 1)), similarity(wanted, histogram(target, 2))};
}

}  // namespace astrolith
