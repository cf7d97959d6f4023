// What the tests of synth share: recipes, and a folder to run the program in.
#pragma once

#include <string>
#include <vector>

#include "tests/apps/program_runner.h"

namespace astrolith {

inline const std::string kSynth = ASTROLITH_SYNTH;

inline const std::string kTwoSpheres = R"({"format_version": 1, "length_unit": "km",
  "body": {"type": "metaballs", "spheres": [[0, 0, 0, 1], [1, 0, 0, 0.75]]},
  "layers": [{"type": "simplex", "amplitude": 0.05, "frequency": 2, "octaves": 4}]})";

inline const std::string kTexture = R"({"format_version": 1, "length_unit": "m",
  "layers": [{"type": "gabor", "pixel_size": 0.01, "height_rms": 0.002, "lobes": [[4, 0.125, -0.25, 1]]}]})";

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

class SynthTest : public ::testing::Test {
 protected:
  // Runs with --resolution 32 and returns the bytes of the output.
  std::string synthesise(const std::string& output, std::vector<std::string> more) {
    const std::string file = (folder_ / output).string();
    std::vector<std::string> arguments{folder_.write("r.json", kTwoSpheres), "-o", file, "--resolution",
                                       "32"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const testing::Outcome outcome = testing::run_program(kSynth, arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return testing::text_of(file);
  }
  void expect_recipe_refused(const std::string& recipe, const std::string& culprit) {
    const std::string file = folder_.write("bad.json", recipe);
    testing::expect_refusal(folder_, kSynth,
                            {file, "-o", (folder_ / "out.ply").string(), "--resolution", "16"},
                            "bad.json: " + culprit);
  }

  testing::WorkFolder folder_;
};

}  // namespace astrolith
