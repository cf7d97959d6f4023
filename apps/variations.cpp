#include "apps/variations.h"

#include <fmt/format.h>

#include <optional>

#include "descriptor/histogram_distance.h"
#include "descriptor/shape_description.h"
#include "geometry/mesh_topology.h"
#include "numerics/errors.h"
#include "recipe/recipe_json.h"
#include "synthesis/implicit_field.h"
#include "synthesis/mesher.h"
#include "synthesis/recipe_variation.h"

namespace astrolith {
namespace {

constexpr int kResolution = 128;  // cells along the longest side of the meshes that are measured
constexpr std::int64_t kPoints = 5000;
constexpr int kHalvings = 5;

TriangleMesh mesh_of(const Recipe& recipe) {
  const ImplicitField field(recipe);
  MeshCollector collector;
  if (!field.bounds().empty()) mesh_field(field, field.bounds(), kResolution, collector);
  return std::move(collector.mesh);
}

// Each with a sampling of its own: two of one shape are not the same.
ShapeHistogram histogram_of(const TriangleMesh& mesh, std::uint64_t seed) {
  DescriptionOptions options;
  options.points = kPoints;
  options.seed = seed;
  return describe_shape(mesh, options).histogram;
}

}  // namespace

VariationReference reference_of(const Recipe& recipe) {
  const TriangleMesh mesh = mesh_of(recipe);
  if (mesh.triangles.empty()) throw InputError("the recipe's surface is empty; there is nothing to vary");
  return reference_of(mesh, analyze_topology(mesh).components);
}

VariationReference reference_of(const TriangleMesh& mesh, std::int64_t components) {
  return {histogram_of(mesh, 1), components};
}

Variation find_variation(const Recipe& recipe, const VariationReference& reference, double delta,
                         std::uint64_t variation_seed, const Progress& progress) {
  std::optional<Variation> best;
  // Whether the variation is one that may be given out.
  const auto attempt = [&](double strength) {
    Variation variation{vary_recipe(recipe, strength, variation_seed), strength, 0.0};
    const TriangleMesh mesh = mesh_of(variation.recipe);
    if (mesh.triangles.empty()) return false;
    variation.similarity = similarity(reference.histogram, histogram_of(mesh, 2 + variation_seed));
    const bool good =
        variation.similarity >= 1.0 - delta && analyze_topology(mesh).components == reference.components;
    if (good) best = std::move(variation);
    return good;
  };
  if (!attempt(0.0)) {
    throw InputError(
        fmt::format("a similarity of {:.3g} is out of reach: other noise of the same kind leaves "
                    "less; allow for more difference",
                    1.0 - delta));
  }
  double low = 0.0, high = 1.0;
  if (attempt(high)) low = high;
  for (int i = 0; i < kHalvings && low < high; ++i) {
    if (!report(progress, (i + 1.0) / kHalvings, fmt::format("similarity {:.3f}", best->similarity))) break;
    const double middle = 0.5 * (low + high);
    (attempt(middle) ? low : high) = middle;
  }
  best->recipe.provenance.achieved = {{"similarity", round_to_seven_digits(best->similarity)}};
  return *std::move(best);
}

}  // namespace astrolith
