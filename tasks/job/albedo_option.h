// --albedo, alike in all programs that make recipes of bodies.
#pragma once

#include <string>

#include "recipe/recipe.h"
#include "tasks/job/job.h"

namespace astrolith {

struct AlbedoOption {
  std::string name = {};  // of known_albedos(), or "drawn"; empty: the recipe keeps its own

  void add_to(OptionTable& options);
  // Gives a recipe with a body the albedo that was asked for, and says so in the summary.
  void apply(Job& job, Recipe& recipe) const;
};

}  // namespace astrolith
