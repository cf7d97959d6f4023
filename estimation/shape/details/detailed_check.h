// Measures a recipe of base and details: synthesis makes a mesh of it, which is compared with the target.
#pragma once

#include <cstdint>

#include "descriptor/shape_histogram.h"
#include "estimation/shape/fit/fit_check.h"
#include "recipe/recipe.h"

namespace astrolith {

// Like check_fit, for a whole recipe. The recipe is in the frame and the unit of the target's file; the check
// is in the target's frame.
FitCheck check_recipe(const TargetBody& target, const Recipe& recipe, int resolution, std::int64_t samples,
                      std::uint64_t seed);

// The similarity of two shapes, and the similarity of two samplings of the first. A candidate above this
// floor cannot be told from a perfect one. Both are at most 1.
struct MeasuredSimilarity {
  double similarity = 0.0, floor = 0.0;
};

// Compares histograms of `points` fresh Poisson-disk samples each.
MeasuredSimilarity measure_similarity(const TriangleMesh& target, const TriangleMesh& candidate,
                                      PairFeatures features, std::int64_t points, std::uint64_t seed);

}  // namespace astrolith
