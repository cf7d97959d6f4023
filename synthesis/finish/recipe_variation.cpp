#include "synthesis/finish/recipe_variation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geometry/mesh_topology.h"
#include "geometry/surface/surface_distance.h"
#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "numerics/portable_double.h"
#include "recipe/recipe_json.h"
#include "synthesis/body/body_spheres.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/finish/lay_on_base.h"
#include "synthesis/noise/coordinate_warp.h"

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
      : mesh(std::move(own)),
        tree(mesh),
        diagonal(bounding_box(mesh).diagonal()),
        pieces(count_pieces(mesh)) {}

  static Box bounding_box(const TriangleMesh& mesh) {
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

// Sizes of the deformation at strength 1: the standard deviation of the logarithms of the axes' stretch, and
// the largest displacement of the bend as a fraction of half the diagonal of the body.
constexpr double kAxisStretch = 0.3;
constexpr double kBend = 0.35;
constexpr double kBendCycles = 0.5;  // cycles in half a diagonal

// Standard deviations of the logarithms of amplitudes and frequencies at strength 1.
constexpr double kAmplitudeChange = 0.5;
constexpr double kFrequencyChange = 0.25;

// The standard deviations of the logarithms of a morph's roughness and shares at strength 1, and that of the
// turns of its donors in degrees.
constexpr double kRoughnessChange = 0.4;
constexpr double kShareChange = 0.8;
constexpr double kTurn = 30.0;

enum Stream : std::uint64_t { kSeedStream, kAxesStream, kBendStream, kLayerStream, kMorphStream };

Box sphere_bounds(const MetaballBody& body) {
  Box box;
  for (const Sphere& s : adding_spheres(body)) {
    const Vec3d r{s.radius, s.radius, s.radius};
    box.extend(s.center - r);
    box.extend(s.center + r);
  }
  return box;
}

// A smooth map of space: a bend, followed by a stretch along the axes.
class Deformation {
 public:
  Deformation(const Box& body, double strength, std::uint64_t seed)
      : center_(body.center()),
        step_(0.01 * body.diagonal()),
        warp_(make_coordinate_warp(bend(body, strength), bend_seed(seed), body, arrays_)) {
    CounterRandom random(seed, kAxesStream);
    const auto factor = [&] {
      return portable::exp(kAxisStretch * strength * std::clamp(random.normal(), -2.0, 2.0));
    };
    stretch_ = {factor(), factor(), factor()};
  }

  Vec3d operator()(const Vec3d& p) const {
    const auto x = static_cast<float>(p.x), y = static_cast<float>(p.y), z = static_cast<float>(p.z);
    float wx = 0, wy = 0, wz = 0;
    warp_points(warp_, arrays_.view(), 1, &x, &y, &z, &wx, &wy, &wz);
    const Vec3d moved = p + Vec3d{double{wx} - double{x}, double{wy} - double{y}, double{wz} - double{z}};
    const Vec3d d = moved - center_;
    return center_ + Vec3d{stretch_.x * d.x, stretch_.y * d.y, stretch_.z * d.z};
  }

  // The factor by which lengths grow near p: the cube root of the growth of a small volume, limited to 0.2 ..
  // 5 before the root.
  double growth(const Vec3d& p) const {
    const auto slope = [&](const Vec3d& d) { return (0.5 / step_) * ((*this)(p + d) - (*this)(p - d)); };
    const Vec3d a = slope({step_, 0, 0}), b = slope({0, step_, 0}), c = slope({0, 0, step_});
    return portable::cbrt(std::clamp(dot(a, cross(b, c)), 0.2, 5.0));
  }

 private:
  static Warp bend(const Box& body, double strength) {
    const double half = 0.5 * body.diagonal();
    Warp warp;
    warp.amplitude = kBend * strength * half;
    warp.frequency = kBendCycles / half;
    warp.octaves = 1;
    return warp;
  }
  static std::uint32_t bend_seed(std::uint64_t seed) { return hash_seed(seed, kBendStream); }

  Vec3d center_;
  double step_;
  ArrayStore arrays_;
  CoordinateWarp warp_;
  Vec3d stretch_{1, 1, 1};
};

// Varies a shape between measured ones: its axes, what it has of each donor, and how rough it is.
void vary(Morph& morph, double strength, std::uint64_t seed) {
  CounterRandom random(seed, kMorphStream);
  const auto change = [&](double& number, double deviation) {
    number = round_to_seven_digits(
        number * portable::exp(deviation * strength * std::clamp(random.normal(), -2.0, 2.0)));
  };
  for (double* axis : {&morph.half_axes.x, &morph.half_axes.y, &morph.half_axes.z})
    change(*axis, kAxisStretch);
  change(morph.roughness, kRoughnessChange);
  for (Donor& donor : morph.donors) {
    change(donor.share, kShareChange);
    donor.turn =
        std::clamp(round_to_seven_digits(donor.turn + kTurn * strength * random.normal()), -360.0, 360.0);
  }
}

// Varies the fields that a layer names. Returns the factor by which the heights of the layer have grown.
double vary(Layer& layer, double strength, CounterRandom random) {
  return std::visit(
      [&](auto& l) {
        if constexpr (requires { l.varied(); }) {
          const VariedFields varied = l.varied();
          const double growth = portable::exp(kAmplitudeChange * strength * random.normal());
          varied.height = round_to_seven_digits(varied.height * growth);
          varied.frequency = round_to_seven_digits(
              varied.frequency * portable::exp(kFrequencyChange * strength * random.normal()));
          return growth;
        } else {
          return 1.0;
        }
      },
      layer);
}

const std::string& layer_name(const Layer& layer) {
  return std::visit([](const auto& l) -> const std::string& { return l.name; }, layer);
}

// Masks follow the heights of the layer that they refer to, the last layer of that name before them. The
// width of a blend follows the heights of its own layer. What was covered therefore stays covered. `growth`
// holds the factor of each layer's heights.
void follow_heights(const std::vector<double>& growth, std::vector<Layer>& layers) {
  for (std::size_t i = 0; i < layers.size(); ++i) {
    if (LayerUse* use = find_use(layers[i])) {
      use->combination.width = round_to_seven_digits(use->combination.width * growth[i]);
    }
    LayerMask* mask = find_mask(layers[i]);
    if (mask == nullptr) continue;
    std::size_t asked = i;
    while (asked > 0 && layer_name(layers[asked - 1]) != mask->layer) --asked;
    if (asked == 0) continue;
    mask->from = round_to_seven_digits(mask->from * growth[asked - 1]);
    mask->to = round_to_seven_digits(mask->to * growth[asked - 1]);
  }
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

Recipe vary_recipe(const Recipe& recipe, double strength, std::uint64_t variation_seed, VariedNoise noise) {
  Recipe varied = recipe;
  if (noise == VariedNoise::kNew) {
    varied.seed =
        CounterRandom(recipe.seed ^ (variation_seed * 0x9e3779b97f4a7c15u), kSeedStream).next() >> 11;
  }
  varied.provenance.achieved.clear();
  if (varied.body->morph) {
    vary(*varied.body->morph, strength, variation_seed);
  } else {
    const Deformation deform(sphere_bounds(*recipe.body), strength, variation_seed);
    for_each_sphere(*varied.body, [&](Sphere& s) {
      const Vec3d c = deform(s.center);
      s.radius = round_to_seven_digits(s.radius * deform.growth(s.center));
      s.center = {round_to_seven_digits(c.x), round_to_seven_digits(c.y), round_to_seven_digits(c.z)};
    });
  }
  std::vector<double> growth;
  for (std::size_t i = 0; i < varied.layers.size(); ++i) {
    const CounterRandom random(variation_seed, (std::uint64_t{kLayerStream} << 32) + i);
    varied.layers[i] = drawn_from(*recipe.body, varied.layers[i]);
    growth.push_back(vary(varied.layers[i], strength, random));
  }
  follow_heights(growth, varied.layers);
  return varied;
}

}  // namespace astrolith
