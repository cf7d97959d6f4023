// The erosion of synth's mesh.
#pragma once

#include "apps/program.h"
#include "geometry/triangle_mesh.h"
#include "recipe/recipe.h"

namespace astrolith {

// Erodes the mesh of a whole body as its recipe says. The summary and a line on stderr state the result.
void erode_mesh(Program& program, const Erosion& erosion, TriangleMesh& mesh);

}  // namespace astrolith
