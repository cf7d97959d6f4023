// Draws the sizes and places of a population (recipe/landforms.h) on the bare body.
#pragma once

#include <string>
#include <vector>

#include "numerics/hash_random.h"
#include "recipe/recipe.h"
#include "synthesis/landforms/bare_surface.h"

namespace astrolith {

struct DrawnLandform {
  Vec3d position;           // on the bare surface
  double diameter = 0.0;    // length units
  CounterRandom random{0};  // the landform's own random numbers, for its other properties
};

// The diameter at quantile u in [0, 1) of the population's law N(> D) ~ D^-exponent between its limits.
double power_law_diameter(const Population& population, double u);

// The landforms of a population. Landform i does not depend on the count. Throws InputError, naming `where`,
// when a density would draw more than about kMaxDrawnLandforms.
std::vector<DrawnLandform> draw_population(const Population& population, const BareSurface& surface,
                                           std::uint64_t seed, int layer_index, const std::string& where);

}  // namespace astrolith
