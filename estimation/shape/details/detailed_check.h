// How good a recipe of base and details is: the mesh that synthesis makes of it, measured against the target.
#pragma once

#include <cstdint>

#include "descriptor/shape_histogram.h"
#include "estimation/shape/fit/fit_check.h"
#include "recipe/recipe.h"

namespace astrolith {

// As check_fit, for a whole recipe in the frame and the unit of the target's file.
FitCheck check_recipe(const TargetBody& target, const Recipe& recipe, int resolution, std::int64_t samples,
                      std::uint64_t seed);

// Of two shapes, and of two samplings of the first: no candidate can be told from 1 above that.
struct MeasuredSimilarity {
  double similarity = 0.0, floor = 0.0;
};

// Histograms of `points` fresh Poisson-disk samples each.
MeasuredSimilarity measure_similarity(const TriangleMesh& target, const TriangleMesh& candidate,
                                      PairFeatures features, std::int64_t points, std::uint64_t seed);

}  // namespace astrolith
