// The recipe: the contract between fitting and synthesis, and the meaning of a recipe's JSON file
// (recipe/recipe.schema.json). The structs are plain data. recipe_json.h reads and writes them, and checks
// every rule that these headers state.
//
// All lengths are in `length_unit`; positions are in the body-fixed frame.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "recipe/body.h"
#include "recipe/family.h"
#include "recipe/landforms.h"
#include "recipe/noise_layers.h"
#include "recipe/population.h"
#include "recipe/relief_layer.h"

namespace astrolith {

inline constexpr int kRecipeFormatVersion = 1;

using Layer = std::variant<FractalLayer, SpotLayer, SparseLayer, CraterLayer, BoulderLayer, RandomPhaseLayer,
                           PhasorLayer, GaborLayer, ExemplarLayer, ReliefLayer>;

// The layer's `type` in a file: "simplex", "perlin" or "worley" of a fractal layer, kType of the others.
std::string_view type_word(const Layer& layer);

// What the layer is.
inline LayerTraits layer_traits(const Layer& layer) {
  return std::visit([]<class Kind>(const Kind&) { return Kind::kTraits; }, layer);
}

// The layer's use, or null for craters and boulders.
inline LayerUse* find_use(Layer& layer) {
  return std::visit(
      []<class Kind>(Kind& l) -> LayerUse* {
        if constexpr (Kind::kTraits.is_noise) {
          return &l.use;
        } else {
          return nullptr;
        }
      },
      layer);
}
inline const LayerUse* find_use(const Layer& layer) { return find_use(const_cast<Layer&>(layer)); }

// The population of a layer of craters or boulders, or null.
inline Population* find_population(Layer& layer) {
  return std::visit(
      []<class Kind>(Kind& l) -> Population* {
        if constexpr (Kind::kTraits.is_noise) {
          return nullptr;
        } else {
          return l.population ? &l.population->drawn : nullptr;
        }
      },
      layer);
}
inline const Population* find_population(const Layer& layer) {
  return find_population(const_cast<Layer&>(layer));
}

// The image that the layer names, or null for kinds without one.
inline NamedImage* find_image(Layer& layer) {
  return std::visit(
      []<class Kind>(Kind& l) -> NamedImage* {
        if constexpr (std::is_base_of_v<NamedImage, Kind>) {
          return &l;
        } else {
          return nullptr;
        }
      },
      layer);
}
inline const NamedImage* find_image(const Layer& layer) { return find_image(const_cast<Layer&>(layer)); }

// Whether the layer has a colour.
inline bool has_color(const Layer& layer) {
  return std::visit(
      [](const auto& l) {
        if constexpr (requires { l.color; }) {
          return static_cast<bool>(l.color);
        } else {
          return false;
        }
      },
      layer);
}

// Whether the layer changes the albedo of the ground.
inline bool has_albedo(const Layer& layer) {
  return std::visit(
      [](const auto& l) {
        if constexpr (requires { l.albedo; }) {
          return l.albedo.has_value();
        } else {
          return l.use.albedo.has_value();
        }
      },
      layer);
}

// Whether the layer paints the surface of a body with its own colours.
inline bool paints(const Layer& layer) {
  return std::visit(
      [](const auto& l) {
        if constexpr (requires { l.paints(); }) {
          return l.paints();
        } else {
          return false;
        }
      },
      layer);
}

// Whether the layer may change a surface. A layer of colour alone does not.
inline bool has_height(const Layer& layer) {
  return std::visit(
      [](const auto& l) {
        if constexpr (requires { l.has_height(); }) {
          return l.has_height();
        } else {
          return true;
        }
      },
      layer);
}

// The locality of a layer of noise, or that of the landforms that a layer draws; null without one.
inline const Locality* find_locality(const Layer& layer) {
  const LayerUse* use = find_use(layer);
  const Population* drawn = find_population(layer);
  if (use != nullptr && use->locality) return &*use->locality;
  return drawn != nullptr && drawn->locality ? &*drawn->locality : nullptr;
}

// The mask of a layer of noise, or that of the landforms that a layer draws; null without one.
inline LayerMask* find_mask(Layer& layer) {
  LayerUse* use = find_use(layer);
  Population* drawn = find_population(layer);
  if (use != nullptr && use->mask) return &*use->mask;
  return drawn != nullptr && drawn->mask ? &*drawn->mask : nullptr;
}
inline const LayerMask* find_mask(const Layer& layer) { return find_mask(const_cast<Layer&>(layer)); }

// The name of the field that decides how high a layer is, for messages: "amplitude", "height_rms" or
// "height_range"; "combine.width" where a blend's joint is wider than the layer is high; or the list of
// landforms, "craters", "boulders" or "population".
std::string_view height_field(const Layer& layer);

// The index of the last layer of this name in the list, or -1.
int find_layer(std::span<const Layer> layers, const std::string& name);

// Thermal erosion of the finished surface (thesis eq. 5.12): material slides down until no slope is steeper
// than the talus angle. Slopes are measured against the gravity of a body of uniform density that may turn
// about +z.
struct Erosion {
  double talus_angle = 35.0;     // degrees, [1, 85]
  int iterations = 10000;        // the most sweeps over the surface, 1 .. 100000
  double density = 2000.0;       // kg / m^3, [1, 30000]
  double rotation_period = 0.0;  // hours, [0.01, 1e6], or 0 for a body at rest
};

// The origin of a recipe.
struct Provenance {
  std::string tool;                                          // program and version, "fit_shape 0.1.0"
  std::string input_name;                                    // name of the fitted file without folders
  std::string input_sha256;                                  // 64 hexadecimal digits, or empty
  std::vector<std::pair<std::string, std::string>> options;  // the user's options, sorted by name
  std::vector<std::pair<std::string, double>> achieved;      // errors of the fit, sorted by name
};

struct Recipe {
  int format_version = kRecipeFormatVersion;
  std::string description;  // for people
  std::string length_unit =
      "km";  // "m", "km", "px" (a texture without a physical scale) or
             // "body" (layers alone: shares of the longest side of the body they are laid on)
  std::string frame = "body-fixed, right-handed, +z spin pole, +x prime meridian";
  // The place in the frame that all positions of the recipe are relative to, length units. Coordinates of a
  // body many of its lengths from the frame's own origin would have too few digits.
  Vec3d origin;
  std::uint64_t seed = 1;  // below 2^53, so that every JSON reader keeps it exact
  Provenance provenance;
  std::optional<MetaballBody> body;          // fit_gabor writes recipes without a body
  std::optional<BodyPopulation> population;  // only in a recipe without a body
  std::vector<Layer> layers;                 // at least one in a recipe without a body and a population
  std::optional<GroundAlbedo> albedo;        // absent: the default, if a layer has one
  std::optional<Erosion> erosion;            // only in a recipe with a body
  std::optional<Family> family;  // what differs between members; the recipe itself stands for none
};

}  // namespace astrolith
