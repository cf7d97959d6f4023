// Measures a recipe of base and details: synthesis makes a mesh of it, which is compared with the target.
#pragma once

#include <cstdint>

#include "estimation/shape/fit/fit_check.h"
#include "recipe/recipe.h"

namespace astrolith {

// Like check_fit, for a whole recipe. The recipe is in the frame and the unit of the target's file; the check
// is in the target's frame.
FitCheck check_recipe(const TargetBody& target, const Recipe& recipe, int resolution, std::int64_t samples,
                      std::uint64_t seed);

}  // namespace astrolith
