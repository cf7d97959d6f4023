// The erosion of a recipe's mesh.
#pragma once

#include "geometry/triangle_mesh.h"
#include "numerics/progress.h"
#include "recipe/recipe.h"
#include "synthesis/finish/erosion.h"

namespace astrolith {

// Erodes a whole body as a recipe says, against the gravity of its mesh, which must be closed. Throws what
// erode() throws, and InputError for a mesh without a facet that has an area.
ErosionStatistics erode_body(const Erosion& erosion, TriangleMesh& mesh, const Progress& progress);

}  // namespace astrolith
