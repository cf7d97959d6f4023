// Minimises by an algorithm of NLopt; arguments as in optimizer.h.
#pragma once

#include "estimation/optimize/optimizer.h"

namespace astrolith {

OptimizeResult nlopt_search(const BatchObjective& objective, const Bounds& bounds,
                            const OptimizeOptions& options, const Progress& progress);

}  // namespace astrolith
