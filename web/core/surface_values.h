// What the page shows of a body as colours: a number at each vertex of its mesh.
#pragma once

#include <string>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "recipe/recipe.h"
#include "synthesis/field/implicit_field.h"

namespace astrolith {

struct SurfaceValues {
  std::vector<float> values;        // (#V)
  std::string unit;                 // "degrees", "m", or empty
  std::vector<std::string> legend;  // the words of the values 0, 1, ..., where they are labels
};

// `what` is
//   "slope"   against the local vertical of a body of even density, in degrees. The body turns as the
//             recipe's erosion or boulders say, and is else at rest.
//   "height"  the elevation over the mean geopotential, in metres
//   "albedo"  the normal albedo, the mean of red, green and blue
//   "label"   the layer that changed the surface most
// `field` is the field of the recipe, `mesh` a closed mesh of it. Throws InputError for another word, for a
// recipe without a length unit, and for the albedo of a recipe that states none; `name` begins the messages.
SurfaceValues find_surface_values(const std::string& what, const Recipe& recipe, const std::string& name,
                                  const ImplicitField& field, const TriangleMesh& mesh);

}  // namespace astrolith
