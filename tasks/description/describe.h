// describe: a mesh, or points with normals, becomes the histogram of its shape, or the statistics of its
// surface.
#pragma once

#include "tasks/job/job.h"

namespace astrolith {

// Declares the options of the job; the result does its work.
JobWork declare_describe(Job& job);

}  // namespace astrolith
