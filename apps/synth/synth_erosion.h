// The erosion of synth's mesh.
#pragma once

#include "apps/program.h"
#include "geometry/triangle_mesh.h"
#include "recipe/recipe.h"
#include "synthesis/field/implicit_field.h"

namespace astrolith {

// Erodes the whole mesh of a field as its recipe says. The summary and a line on stderr state the result.
void erode_mesh(Program& program, const ImplicitField& field, const Recipe& recipe, TriangleMesh& mesh);

}  // namespace astrolith
