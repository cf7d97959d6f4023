// synth: a recipe becomes a closed mesh, a picture of it, or the texture of its layers; or many bodies.
#pragma once

#include "tasks/job/job.h"

namespace astrolith {

// Declares the options of the job; the result does its work.
JobWork declare_synth(Job& job);

}  // namespace astrolith
