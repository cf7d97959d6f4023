// Measured bodies become a population, from which synth draws bodies: the job of the program fit_population.
#pragma once

#include "tasks/job/job.h"

namespace astrolith {

// Declares the job's options. Its work reads models, meshes or recipes, and writes a recipe with a
// population.
JobWork declare_fit_population(Job& job);

}  // namespace astrolith
