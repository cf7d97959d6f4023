// What the tests of synth share: a folder to run the job in.
#pragma once

#include <string>

#include "tasks/synth/synth.h"
#include "tests/tasks/job_runner.h"
#include "tests/tasks/synth/recipes.h"

namespace astrolith {

// r.json is the recipe of two spheres.
class SynthTest : public testing::JobTest {
 protected:
  SynthTest() : JobTest("synth", declare_synth) { write("r.json", kTwoSpheres); }

  // Meshes r.json with --resolution 32 and returns the bytes of the output.
  std::string synthesise(const std::string& output, const std::string& more = "") const {
    succeed("r.json -o " + output + " --resolution 32 " + more);
    return text(output);
  }
  void expect_recipe_refused(const std::string& recipe, const std::string& culprit) const {
    refuse(write("bad.json", recipe) + " -o out.ply --resolution 16", "bad.json: " + culprit);
  }
};

}  // namespace astrolith
