// Minimises by the covariance matrix adaptation evolution strategy; arguments as in optimizer.h.
#pragma once

#include "estimation/optimize/optimizer.h"

namespace astrolith {

OptimizeResult cma_es(const BatchObjective& objective, const Bounds& bounds, const OptimizeOptions& options,
                      const Progress& progress);

}  // namespace astrolith
