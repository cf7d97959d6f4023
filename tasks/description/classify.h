// classify: learns classes of shapes from folders of meshes, and says to which of them other meshes belong.
#pragma once

#include "tasks/job/job.h"

namespace astrolith {

// Declares the options of the job; the result does its work.
JobWork declare_classify(Job& job);

}  // namespace astrolith
