// Varies recipes: bodies of the same kind that are not the same body (thesis section 4.4).
#pragma once

#include <cstdint>

#include "recipe/recipe.h"

namespace astrolith {

enum class VariedNoise { kNew, kKept };

// Varies a recipe. It gets another seed, so that all noise is drawn anew, unless the noise is to be kept. In
// proportion to `strength` >= 0
//   - the whole body is bent by noise about as wide as itself and stretched along its axes; spheres move
//     together and grow with the space around them, so that what was joined stays joined;
//   - amplitudes and frequencies of fractal layers are multiplied by log-normal factors; masks and widths of
//     blends follow the heights that they are about.
// At strength 1 axes change by about a third and details by about a half. The same recipe, strength and
// variation seed give the same recipe; strengths of one seed lie on one path. The provenance stays that of
// the original, without its achieved results. The recipe must be valid and have a body.
Recipe vary_recipe(const Recipe& recipe, double strength, std::uint64_t variation_seed,
                   VariedNoise noise = VariedNoise::kNew);

}  // namespace astrolith
