#include "apps/variations.h"

#include <fmt/format.h>

#include <optional>

#include "descriptor/histogram_distance.h"
#include "descriptor/shape_description.h"
#include "geometry/mesh_topology.h"
#include "numerics/errors.h"
#include "recipe/recipe_json.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/finish/recipe_variation.h"

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

// What is asked for, and variations of one seed on the way to it.
struct Search {
  const Recipe& recipe;
  const VariationReference& reference;
  double least;  // similarity
  std::uint64_t seed;

  // Nothing where the variation may not be given out.
  std::optional<Variation> attempt(VariedNoise noise, double strength) const {
    Variation variation{vary_recipe(recipe, strength, seed, noise), strength, 0.0};
    const TriangleMesh mesh = mesh_of(variation.recipe);
    if (mesh.triangles.empty()) return {};
    variation.similarity = similarity(reference.histogram, histogram_of(mesh, 2 + seed));
    if (variation.similarity < least) return {};
    if (analyze_topology(mesh).components != reference.components) return {};
    return variation;
  }

  // Nothing where even strength 0 is too much.
  std::optional<Variation> strongest(VariedNoise noise, const Progress& progress) const {
    std::optional<Variation> best = attempt(noise, 0.0);
    if (!best) return {};
    double low = 0.0, high = 1.0;
    if (auto strong = attempt(noise, high)) return strong;
    for (int i = 0; i < kHalvings; ++i) {
      if (!report(progress, (i + 1.0) / kHalvings, fmt::format("similarity {:.3f}", best->similarity))) break;
      const double middle = 0.5 * (low + high);
      if (auto better = attempt(noise, middle)) {
        best = std::move(better);
        low = middle;
      } else {
        high = middle;
      }
    }
    return best;
  }
};

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
  const Search search{recipe, reference, 1.0 - delta, variation_seed};
  std::optional<Variation> found = search.strongest(VariedNoise::kNew, progress);
  if (!found) found = search.strongest(VariedNoise::kKept, progress);
  if (!found) {
    throw InputError(
        fmt::format("a similarity of {:.3g} is out of reach: two samplings of the same body differ by more; "
                    "allow for more difference",
                    1.0 - delta));
  }
  found->recipe.provenance.achieved = {{"similarity", round_to_seven_digits(found->similarity)}};
  return *std::move(found);
}

}  // namespace astrolith
