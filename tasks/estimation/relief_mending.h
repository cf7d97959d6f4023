// Keeps a relief from making parts and handles that the target lacks.
#pragma once

#include <cstddef>
#include <cstdint>

#include "estimation/shape/fit/shape_fit.h"
#include "estimation/shape/target/target_body.h"
#include "numerics/progress.h"
#include "recipe/recipe.h"

namespace astrolith {

// Halves the heights of the recipe's relief where the measured fit has parts or handles that the target
// lacks or does not make, and measures again, eight times at most. The recipe and the fit stay as they were
// where that does not help. With `most_bytes` above 0 the compact recipe stays within them. Returns the
// number of heights that were halved, each as often as it was.
std::size_t mend_relief(const TargetBody& target, const ShapeFitOptions& options, std::size_t most_bytes,
                        const Progress& progress, Recipe& recipe, ShapeFitResult& fit);

}  // namespace astrolith
