// Where boulders lie on a body whose relief shows smooth ground: on rough ground alone.
#pragma once

#include <optional>

#include "recipe/recipe.h"

namespace astrolith {

struct RoughGround {
  LayerMask mask;            // for a population: the relief's roughness over the distance of its heights
  double mean_weight = 1.0;  // of the mask over the body, in (0, 1]
};

// The rough ground of the recipe's last relief, which gets a name where it has none. Boulders of a rubble
// pile gather where the ground is rough. The weight is 1 from the median roughness up, and 0 below a quarter
// of it and on the smoothest tenth of the ground, where a relief shows no more than the steps of its heights.
// None where the recipe has no relief, or one without roughness.
std::optional<RoughGround> rough_ground(Recipe& recipe);

}  // namespace astrolith
