// The recipe: the contract between fitting and synthesis, and the meaning of the JSON file of the same shape
// (recipe/recipe.schema.json). Plain data; recipe_json.h reads and writes it, and checks every rule stated
// here.
//
// All lengths are in `length_unit`; positions are in the body-fixed frame.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "recipe/body.h"
#include "recipe/landforms.h"
#include "recipe/limits.h"
#include "recipe/noise_layers.h"

namespace astrolith {

inline constexpr int kRecipeFormatVersion = 1;

using Layer = std::variant<FractalLayer, GaborLayer, SpotLayer, CraterLayer, BoulderLayer, SparseLayer,
                           RandomPhaseLayer, PhasorLayer>;

// Null for the kinds that have none.
inline LayerUse* use_of(Layer& layer) {
  return std::visit(
      [](auto& l) -> LayerUse* {
        if constexpr (requires { l.use; }) {
          return &l.use;
        } else {
          return nullptr;
        }
      },
      layer);
}
inline const LayerUse* use_of(const Layer& layer) { return use_of(const_cast<Layer&>(layer)); }

// The last of this name; -1 where there is none.
int find_layer(std::span<const Layer> layers, const std::string& name);

// Thermal erosion of the finished surface (thesis eq. 5.12): slopes steeper than the talus angle, measured
// against the gravity of a body of uniform density that may turn about +z, slide down until they are not.
struct Erosion {
  double talus_angle = 35.0;     // degrees, [1, 85]
  int iterations = 10000;        // sweeps over the surface at most, 1 .. 100000; ends when all has settled
  double density = 2000.0;       // kg / m^3, [1, 30000]
  double rotation_period = 0.0;  // hours, 0 (at rest) or [0.01, 1e6]
};

// Where a recipe came from.
struct Provenance {
  std::string tool;                                          // "fit_shape 0.1.0"
  std::string input_name;                                    // file name without folders
  std::string input_sha256;                                  // 64 hexadecimal digits, or empty
  std::vector<std::pair<std::string, std::string>> options;  // as given, sorted by name
  std::vector<std::pair<std::string, double>> achieved;      // errors reached, sorted by name
};

struct Recipe {
  int format_version = kRecipeFormatVersion;
  std::string description;         // for people
  std::string length_unit = "km";  // "m", "km" or "px" (a texture without a physical scale)
  std::string frame = "body-fixed, right-handed, +z spin pole, +x prime meridian";
  std::uint64_t seed = 1;  // below 2^53, so that every JSON reader keeps it exact
  Provenance provenance;
  std::optional<MetaballBody> body;  // absent in what fit_gabor writes
  std::vector<Layer> layers;
  std::optional<Erosion> erosion;  // of a body with its layers
};

}  // namespace astrolith
