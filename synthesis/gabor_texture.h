// A Gabor layer on a plane: the texture that the layer was fitted to, of any size.
#pragma once

#include <cstdint>
#include <vector>

#include "numerics/progress.h"
#include "recipe/recipe.h"

namespace astrolith {

// Heights at pixel centres, row-major (height x width), x to the right, y down; length units, mean 0,
// standard deviation layer.height_rms. Stationary: the top left part of a larger texture is the smaller
// texture. Each band takes layer.impulses_per_kernel impulses under a kernel, rounded to whole impulses in a
// cell. Throws InputError for a size below 1 x 1. When `progress` asks to stop, the rows not yet made are 0.
std::vector<float> synthesize_texture(const GaborLayer& layer, int width, int height, std::uint64_t seed,
                                      const Progress& progress = {});

}  // namespace astrolith
