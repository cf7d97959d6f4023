// Relatives of a recipe: bodies of the same kind that are not the same body (thesis section 4.4).
#pragma once

#include <cstdint>

#include "recipe/recipe.h"

namespace astrolith {

enum class VariedNoise { kNew, kKept };

// The recipe with another seed, so that every noise is drawn anew unless it is kept, and, in proportion to
// `strength` >= 0,
//   - the whole body stretched along its axes and bent by noise about as wide as itself: spheres move
//     together and grow with the space around them, so that what was joined stays joined;
//   - amplitudes and frequencies of fractal layers multiplied by log-normal factors; masks and joints of
//     blends follow the heights they are about.
// At strength 1 axes change by about a third, and details by about a half. The same recipe, strength and
// variation seed give the same recipe; strengths of one seed lie on one path. Provenance stays that of the
// original but for what it achieved. Expects a valid recipe with a body.
Recipe vary_recipe(const Recipe& recipe, double strength, std::uint64_t variation_seed,
                   VariedNoise noise = VariedNoise::kNew);

}  // namespace astrolith
