// NLopt's algorithms with our bounds, seed, progress and bookkeeping.
#pragma once

#include "estimation/optimize/optimizer.h"

namespace astrolith {

OptimizeResult nlopt_search(const BatchObjective& objective, const Bounds& bounds,
                            const OptimizeOptions& options, const Progress& progress);

}  // namespace astrolith
