#include "tasks/description/variation_reference.h"

#include <fmt/format.h>

#include "descriptor/histogram_distance.h"
#include "descriptor/surface/evened_surface.h"

namespace astrolith {
namespace {

constexpr std::uint64_t kReferenceSeed = 1;

ShapeHistogram shape_histogram(const TriangleMesh& mesh, std::uint64_t seed) {
  DescriptionOptions options;
  options.seed = seed;
  return describe_evened(mesh, options).histogram;
}

}  // namespace

SimilarityMeasure similarity_with(const TriangleMesh& mesh) {
  return [reference = shape_histogram(mesh, kReferenceSeed)](const TriangleMesh& variation,
                                                             std::uint64_t variation_seed) {
    return similarity(reference, shape_histogram(variation, kReferenceSeed + 1 + variation_seed));
  };
}

std::string describe(const Variation& variation) {
  return fmt::format(
      "strength {:.3g}, {}; {:.2g} % of the diagonal from the recipe's own body on average, {:.2g} % at most",
      variation.strength, variation.noise == VariedNoise::kNew ? "new noise" : "its own noise",
      100.0 * variation.mean_distance, 100.0 * variation.max_distance);
}

nlohmann::ordered_json to_json(const Variation& variation) {
  return {{"similarity", variation.similarity},
          {"strength", variation.strength},
          {"noise", variation.noise == VariedNoise::kNew ? "new" : "kept"},
          {"mean_distance", variation.mean_distance},
          {"max_distance", variation.max_distance}};
}

}  // namespace astrolith
