// Takes back heights of a relief where they make what neither the metaballs nor the target have.
#pragma once

#include <cstddef>
#include <vector>

#include "numerics/vec3.h"
#include "recipe/recipe.h"

namespace astrolith {

// Halves the heights that give these points theirs: those around the points' projections on the bare body.
// Halved again and again, the surface there becomes that of the metaballs. Points are in the frame and unit
// of the recipe. Its first relief is one of its own body, as fit_relief() makes it. Returns how many heights
// changed; 0 without a relief.
std::size_t halve_heights(const std::vector<Vec3d>& points, Recipe& recipe);

}  // namespace astrolith
