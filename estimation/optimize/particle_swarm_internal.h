// Particle swarm optimisation with constriction.
#pragma once

#include "estimation/optimize/optimizer.h"

namespace astrolith {

OptimizeResult particle_swarm(const BatchObjective& objective, const Bounds& bounds,
                              const OptimizeOptions& options, const Progress& progress);

}  // namespace astrolith
