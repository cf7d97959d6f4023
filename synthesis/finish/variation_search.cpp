#include "synthesis/finish/variation_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geometry/mesh_topology.h"
#include "geometry/surface/surface_distance.h"
#include "numerics/errors.h"
#include "recipe/recipe_json.h"
#include "synthesis/field/field_mesh.h"

namespace astrolith {
namespace {

constexpr int kResolution = 128;  // cells along the longest side of the meshes that are measured
constexpr double kCrumb = 1e-3;   // pieces of less than this share of the largest piece's volume do not count
constexpr double kLeastStrength = 0x1p-7;
constexpr int kHalvings = 4;  // of the gap between the strongest that will do and one that will not
constexpr std::int64_t kSamples = 20000;  // points of each surface, for the distance between the two
constexpr std::uint64_t kDistanceSeed = 1;

// The recipe's own body, with which all variations are compared.
struct Original {
  TriangleMesh mesh;
  SurfaceTree tree;
  double diagonal;
  std::int64_t pieces;

  explicit Original(TriangleMesh own)
      : mesh(std::move(own)), tree(mesh), diagonal(bounds_of(mesh).diagonal()), pieces(count_pieces(mesh)) {}

  static Box bounds_of(const TriangleMesh& mesh) {
    Box box;
    for (const Vec3d& p : mesh.vertices) box.extend(p);
    return box;
  }
};

// The search for the strongest variation of one seed.
class Search {
 public:
  Search(const Recipe& recipe, const SimilarityMeasure& similarity, double least_similarity,
         std::uint64_t seed, const Progress& progress)
      : recipe_(recipe),
        similarity_(similarity),
        least_similarity_(least_similarity),
        seed_(seed),
        progress_(progress),
        original_(own_mesh(recipe)) {}

  Variation run() {
    std::optional<Variation> found = strongest(VariedNoise::kNew);
    if (!found && !stopped_) found = strongest(VariedNoise::kKept);
    report(progress_, 1.0, "");
    if (!found && stopped_) throw WorkError("variation: stopped before one was found");
    if (!found) refuse();
    return *std::move(found);
  }

 private:
  static TriangleMesh own_mesh(const Recipe& recipe) {
    TriangleMesh mesh = mesh_for_comparison(recipe);
    if (mesh.triangles.empty()) {
      throw InputError("variation: the recipe has no surface to vary; mesh it without variations to see why");
    }
    return mesh;
  }

  // The variation of a strength, or nothing where it will not do.
  std::optional<Variation> attempt(VariedNoise noise, double strength) {
    constexpr double kMostAttempts = 26.0;
    stopped_ = stopped_ ||
               !report(progress_, ++attempts_ / kMostAttempts, "strength " + fmt::format("{:.4f}", strength));
    if (stopped_) return {};
    Variation variation{vary_recipe(recipe_, strength, seed_, noise), strength, noise};
    const TriangleMesh mesh = mesh_for_comparison(variation.recipe);
    if (mesh.triangles.empty() || count_pieces(mesh) != original_.pieces) return {};
    const SurfaceDistanceReport distance =
        surface_distance(original_.mesh, original_.tree, mesh, SurfaceTree(mesh), kSamples, kDistanceSeed);
    variation.mean_distance = distance.mean / original_.diagonal;
    variation.max_distance = distance.max / original_.diagonal;
    if (!(variation.mean_distance >= kLeastVariation)) return {};
    variation.similarity = similarity_(mesh, seed_);
    most_similar_ = std::max(most_similar_.value_or(variation.similarity), variation.similarity);
    if (variation.similarity < least_similarity_) return {};
    return variation;
  }

  std::optional<Variation> strongest(VariedNoise noise) {
    double strength = 1.0;
    std::optional<Variation> best = attempt(noise, strength);
    while (!best && strength > kLeastStrength) best = attempt(noise, strength *= 0.5);
    if (!best) return noise == VariedNoise::kNew ? attempt(noise, 0.0) : std::nullopt;
    double too_strong = 2.0 * strength;
    for (int i = 0; i < kHalvings && best->strength < 1.0; ++i) {
      const double middle = 0.5 * (best->strength + too_strong);
      if (auto stronger = attempt(noise, middle)) {
        best = std::move(stronger);
      } else {
        too_strong = middle;
      }
    }
    return best;
  }

  [[noreturn]] void refuse() const {
    const std::string which = "variation " + std::to_string(seed_) + ": ";
    if (!most_similar_) {
      throw InputError(which +
                       "whatever its strength, it falls into another number of pieces than the body, or is "
                       "no other body; take another number");
    }
    const double largest = std::floor(*most_similar_ * 1e4 - 1e-6) * 1e-4;
    throw InputError(which + "no other body with a similarity of " +
                     fmt::format("{:.6g}", least_similarity_) + " was found; ask for " +
                     fmt::format("{:.4f}", largest) + " at most, a difference of " +
                     fmt::format("{:.4f}", 1.0 - largest));
  }

  const Recipe& recipe_;
  const SimilarityMeasure& similarity_;
  double least_similarity_;
  std::uint64_t seed_;
  const Progress& progress_;
  Original original_;
  std::optional<double> most_similar_;  // of all attempts that are other bodies in as many pieces
  int attempts_ = 0;
  bool stopped_ = false;
};

void state_figures(Variation& variation) {
  variation.recipe.provenance.achieved = {
      {"similarity", round_to_seven_digits(variation.similarity)},
      {"variation_max_distance", round_to_seven_digits(variation.max_distance)},
      {"variation_mean_distance", round_to_seven_digits(variation.mean_distance)},
      {"variation_strength", round_to_seven_digits(variation.strength)}};
}

}  // namespace

TriangleMesh mesh_for_comparison(const Recipe& recipe) {
  const ImplicitField field(recipe);
  MeshCollector collector;
  if (!field.bounds().empty()) mesh_field(field, field.bounds(), kResolution, collector);
  return std::move(collector.mesh);
}

std::int64_t count_pieces(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return 0;
  const std::vector<std::uint32_t> piece = triangle_components(mesh);
  std::vector<double> volumes(std::size_t{*std::max_element(piece.begin(), piece.end())} + 1, 0.0);
  const Vec3d apex = mesh.vertices[mesh.triangles[0][0]];
  for (std::size_t t = 0; t < piece.size(); ++t) {
    const auto at = [&](std::size_t k) { return mesh.vertices[mesh.triangles[t][k]] - apex; };
    volumes[piece[t]] += dot(at(0), cross(at(1), at(2))) / 6.0;
  }
  double largest = 0.0;
  for (double& volume : volumes) largest = std::max(largest, volume = std::fabs(volume));
  return std::count_if(volumes.begin(), volumes.end(), [&](double v) { return v >= kCrumb * largest; });
}

Variation find_variation(const Recipe& recipe, const SimilarityMeasure& similarity, double delta,
                         std::uint64_t variation_seed, const Progress& progress) {
  Variation found = Search(recipe, similarity, 1.0 - delta, variation_seed, progress).run();
  state_figures(found);
  return found;
}

}  // namespace astrolith
