// The body of a recipe without its layers. Landforms are placed on it.
#pragma once

#include "recipe/recipe.h"
#include "synthesis/landforms/bare_surface.h"

namespace astrolith {

// Expects a recipe with a body. Throws InputError for a recipe that ImplicitField refuses.
BareBody bare_body(const Recipe& recipe);

}  // namespace astrolith
