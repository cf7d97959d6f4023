// What of known bodies a recipe is finished with, for synth: landforms below its finest size, and albedo.
#pragma once

#include <optional>
#include <string>

#include "recipe/recipe.h"
#include "tasks/job/albedo_option.h"
#include "tasks/job/job.h"

namespace astrolith {

struct FinishOptions {
  std::string body;   // of --finish; empty or "none": nothing is added
  double from = 0.0;  // length units; 0: the recipe's finest size
  double to = 0.0;    // length units
  AlbedoOption albedo = {};

  bool wanted() const { return !body.empty() && body != "none"; }
};

void declare_finish_options(Job& job, FinishOptions& options);

// Throws InputError for options that do not belong together.
void check_finish(const FinishOptions& options);

// The recipe with the landforms and the albedo that were asked for. Says on stderr and in the summary what of
// them is measured and what is drawn. `file` names the recipe. Throws InputError where a patch of this side
// (0: none) would hold more landforms than a layer draws.
Recipe finished(Job& job, const FinishOptions& options, const Recipe& recipe, const std::string& file,
                double patch_side);

}  // namespace astrolith
