// The jobs that describe shapes and surfaces. Each function declares the options of a job and returns its
// work.
#pragma once

#include "tasks/job/job.h"

namespace astrolith {

// describe: a mesh, or points with normals, becomes the histogram of its shape, or the statistics of its
// surface.
JobWork declare_describe(Job& job);

// compare: how alike two meshes are in shape, how far apart their surfaces lie, and whether one surface
// passes for the other.
JobWork declare_compare(Job& job);

// classify: learns classes of shapes from folders of meshes, and says to which of them other meshes belong.
JobWork declare_classify(Job& job);

// render: a mesh becomes a sunlit picture, in colours of one property of its vertices where asked for.
JobWork declare_render(Job& job);

}  // namespace astrolith
