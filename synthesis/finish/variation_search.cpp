#include "synthesis/finish/variation_search.h"

#include <cstdio>
#include <optional>
#include <string>
#include <utility>

#include "geometry/mesh_topology.h"
#include "numerics/errors.h"
#include "recipe/recipe_json.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/finish/recipe_variation.h"

namespace astrolith {
namespace {

constexpr int kResolution = 128;  // cells along the longest side of the meshes that are measured
constexpr int kHalvings = 5;

std::string printed(const char* format, double value) {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

// The search for the strongest variation of one seed.
struct Search {
  const Recipe& recipe;
  const VariationReference& reference;
  double least_similarity;
  std::uint64_t seed;

  // The variation of a strength, or nothing where it is too different.
  std::optional<Variation> attempt(VariedNoise noise, double strength) const {
    Variation variation{vary_recipe(recipe, strength, seed, noise), strength, 0.0};
    const TriangleMesh mesh = mesh_for_comparison(variation.recipe);
    if (mesh.triangles.empty()) return {};
    variation.similarity = reference.similarity(mesh, seed);
    if (variation.similarity < least_similarity) return {};
    if (analyze_topology(mesh).components != reference.components) return {};
    return variation;
  }

  // The strongest variation, or nothing where even strength 0 is too much.
  std::optional<Variation> strongest(VariedNoise noise, const Progress& progress) const {
    std::optional<Variation> best = attempt(noise, 0.0);
    if (!best) return {};
    double low = 0.0, high = 1.0;
    if (auto strong = attempt(noise, high)) return strong;
    for (int i = 0; i < kHalvings; ++i) {
      if (!report(progress, (i + 1.0) / kHalvings, printed("similarity %.3f", best->similarity))) break;
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

TriangleMesh mesh_for_comparison(const Recipe& recipe) {
  const ImplicitField field(recipe);
  MeshCollector collector;
  if (!field.bounds().empty()) mesh_field(field, field.bounds(), kResolution, collector);
  return std::move(collector.mesh);
}

Variation find_variation(const Recipe& recipe, const VariationReference& reference, double delta,
                         std::uint64_t variation_seed, const Progress& progress) {
  const Search search{recipe, reference, 1.0 - delta, variation_seed};
  std::optional<Variation> found = search.strongest(VariedNoise::kNew, progress);
  if (!found) found = search.strongest(VariedNoise::kKept, progress);
  if (!found) {
    throw InputError(
        "a similarity of " + printed("%.3g", 1.0 - delta) +
        " is out of reach: two samplings of the same body differ by more; allow for more difference");
  }
  found->recipe.provenance.achieved = {{"similarity", round_to_seven_digits(found->similarity)}};
  return *std::move(found);
}

}  // namespace astrolith
