// Layers that a fit adds to its body besides those of a search: another recipe's, a photo's, and noise like
// what the base leaves of the target.
#pragma once

#include <string>

#include "estimation/shape/target/target_body.h"
#include "numerics/progress.h"
#include "recipe/recipe.h"

namespace astrolith {

// Reads a recipe whose layers can be scaled to a fitted body. Throws InputError for one without body or
// layers, and for a layer with a locality group, since a fitted body has no groups.
Recipe read_details(const std::string& file);

// Adds the layers of another recipe, scaled by the ratio of the two bodies' bounding-box diagonals. Returns
// the ratio.
double transfer_details(const Recipe& other, Recipe& recipe);

// Adds the Gabor layers of a photo's recipe as the finest detail. `mm_per_px` is the size of a pixel,
// `height_mm` the root mean square height of the first layer, both in millimetres; 0: as the photo's recipe
// says. Throws InputError for a recipe without a Gabor layer, or in pixels without both sizes. It also throws
// for a layer that a locality group, a mask by another kind of layer or a warp of the recipe makes
// impossible.
void add_micro_layers(const std::string& file, double mm_per_px, double height_mm, Recipe& recipe);

// Adds a layer of Gabor noise like the heights that the base leaves of the target. Returns a sentence about
// the layer.
std::string add_residual_texture(const TargetBody& target, std::uint64_t seed, const Progress& progress,
                                 Recipe& recipe);

}  // namespace astrolith
