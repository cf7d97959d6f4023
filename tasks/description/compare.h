// compare: how alike two meshes are in shape, how far apart their surfaces lie, and whether one surface
// passes for the other.
#pragma once

#include "tasks/job/job.h"

namespace astrolith {

// Declares the options of the job; the result does its work.
JobWork declare_compare(Job& job);

}  // namespace astrolith
