// What the tests of synth share: recipes, and a folder to run the program in.
#pragma once

#include <string>

#include "tests/apps/program_runner.h"

namespace astrolith {

inline const std::string kSynth = ASTROLITH_SYNTH;

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

// r.json is the recipe of two spheres.
class SynthTest : public testing::ProgramTest {
 protected:
  SynthTest() : ProgramTest(kSynth) { write("r.json", kTwoSpheres); }

  // Meshes r.json with --resolution 32 and returns the bytes of the output.
  std::string synthesise(const std::string& output, const std::string& more = "") const {
    succeed("r.json -o " + output + " --resolution 32 " + more);
    return text(output);
  }
  // The summary of a run of the command line.
  nlohmann::json figures(const std::string& line) const {
    succeed(line + " --summary s.json");
    return json("s.json");
  }
  void expect_recipe_refused(const std::string& recipe, const std::string& culprit) const {
    refuse(write("bad.json", recipe) + " -o out.ply --resolution 16", "bad.json: " + culprit);
  }
};

}  // namespace astrolith
