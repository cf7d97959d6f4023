// gravity: potential, slope and elevation of a body of uniform density that turns.
#pragma once

#include "tasks/job/job.h"

namespace astrolith {

// Declares the options of the job; the result does its work.
JobWork declare_gravity(Job& job);

}  // namespace astrolith
