// Recipes of the tests of synth.
#pragma once

#include <string>

namespace astrolith {

inline const std::string kTwoSpheres = R"({"format_version": 1, "length_unit": "km",
  "body": {"type": "metaballs", "spheres": [[0, 0, 0, 1], [1, 0, 0, 0.75]]},
  "layers": [{"type": "simplex", "amplitude": 0.05, "frequency": 2, "octaves": 4}]})";

inline const std::string kTexture = R"({"format_version": 1, "length_unit": "m",
  "layers": [{"type": "gabor", "pixel_size": 0.01, "height_rms": 0.002, "lobes": [[4, 0.125, -0.25, 1]]}]})";

// A ball of one unit, with further fields of the recipe.
inline std::string ball_recipe(const std::string& unit, double radius, const std::string& more = "") {
  return R"({"format_version": 1, "length_unit": ")" + unit +
         R"(", "body": {"type": "metaballs", "spheres": [[0, 0, 0, )" + std::to_string(radius) + "]]}" +
         more + "}";
}

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

}  // namespace astrolith
