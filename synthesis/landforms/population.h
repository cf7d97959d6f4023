// Draws the sizes and places of a population on the bare body.
#pragma once

#include <string>
#include <vector>

#include "numerics/hash_random.h"
#include "recipe/recipe.h"
#include "synthesis/landforms/bare_surface.h"

namespace astrolith {

struct DrawnLandform {
  Vec3d position;  // on the bare surface
  double diameter = 0.0;
  CounterRandom random{0};  // for whatever else there is to draw
};

// Inverse of N(> D) ~ D^-exponent between the limits, for u in [0, 1).
double power_law_diameter(const Population& population, double u);

// Feature i is the same whatever the count. Throws InputError, naming `where`, when a density would draw more
// than kMaxDrawnLandforms.
std::vector<DrawnLandform> draw_population(const Population& population, const BareSurface& surface,
                                           std::uint64_t seed, int layer_index, const std::string& where);

}  // namespace astrolith
