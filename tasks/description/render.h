// render: a mesh becomes a sunlit picture, in colours of one property of its vertices where asked for.
#pragma once

#include "tasks/job/job.h"

namespace astrolith {

// Declares the options of the job; the result does its work.
JobWork declare_render(Job& job);

}  // namespace astrolith
