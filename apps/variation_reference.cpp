#include "apps/variation_reference.h"

#include "descriptor/histogram_distance.h"
#include "descriptor/shape_description.h"
#include "geometry/mesh_topology.h"
#include "numerics/errors.h"

namespace astrolith {
namespace {

constexpr std::int64_t kPoints = 5000;
constexpr std::uint64_t kReferenceSeed = 1;

ShapeHistogram histogram_of(const TriangleMesh& mesh, std::uint64_t seed) {
  DescriptionOptions options;
  options.points = kPoints;
  options.seed = seed;
  return describe_shape(mesh, options).histogram;
}

}  // namespace

VariationReference reference_of(const Recipe& recipe) {
  const TriangleMesh mesh = mesh_for_comparison(recipe);
  if (mesh.triangles.empty()) throw InputError("the recipe's surface is empty; there is nothing to vary");
  return reference_of(mesh, analyze_topology(mesh).components);
}

VariationReference reference_of(const TriangleMesh& mesh, std::int64_t components) {
  const auto measure = [reference = histogram_of(mesh, kReferenceSeed)](const TriangleMesh& variation,
                                                                        std::uint64_t variation_seed) {
    return similarity(reference, histogram_of(variation, kReferenceSeed + 1 + variation_seed));
  };
  return {measure, components};
}

}  // namespace astrolith
