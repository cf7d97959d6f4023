// The body whose gravity is asked for.
#pragma once

#include <string>

#include "geometry/triangle_mesh.h"
#include "numerics/progress.h"
#include "recipe/recipe.h"

namespace astrolith {

struct GravityBody {
  TriangleMesh mesh;            // closed, counter-clockwise from outside
  std::string unit;             // of its coordinates
  double metres = 1.0;          // per unit
  std::string unit_words = {};  // what is to be said of an assumed unit; empty for a stated one
};

// The body of a mesh whose coordinates are in `unit`: "m", "km", "cm" or "mm". `name` is what messages call
// the mesh. Throws InputError for a mesh that is open, whose faces wind in opposite senses, or whose volume
// is not positive.
GravityBody make_mesh_body(TriangleMesh mesh, const std::string& unit, const std::string& name);

// The body of a recipe, meshed with `resolution` cells along its longest side; the stage is "mesh". Throws
// InputError for a recipe without a body, with erosion or in pixels.
GravityBody make_recipe_body(const Recipe& recipe, int resolution, const std::string& name,
                             const StageProgress& progress);

}  // namespace astrolith
