// check_tiles: says whether the tiles of a body join to one closed manifold mesh.
#pragma once

#include "tasks/job/job.h"

namespace astrolith {

// Declares the options of the job; the result does its work.
JobWork declare_check_tiles(Job& job);

}  // namespace astrolith
