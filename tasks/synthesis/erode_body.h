// The erosion of a recipe's mesh.
#pragma once

#include "geometry/triangle_mesh.h"
#include "numerics/progress.h"
#include "recipe/recipe.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/finish/erosion.h"

namespace astrolith {

// Erodes the whole mesh of a field as its recipe says, which must have an erosion. Throws what erode()
// throws.
ErosionStatistics erode_body(const ImplicitField& field, const Recipe& recipe, TriangleMesh& mesh,
                             const Progress& progress);

}  // namespace astrolith
