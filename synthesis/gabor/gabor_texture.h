// A Gabor layer on a plane: the texture that the layer was fitted to, of any size.
#pragma once

#include <cstdint>
#include <vector>

#include "numerics/progress.h"
#include "recipe/recipe.h"

namespace astrolith {

struct TextureOptions {
  std::uint64_t seed = 1;
  int stream = 0;  // textures of one seed and different streams are independent
  // The texture repeats after so many pixels, to float rounding and without a seam; 0 = never. Both or none.
  int period_width = 0;
  int period_height = 0;
};

// Heights at pixel centres, row-major (height x width), x to the right, y down; length units, mean 0,
// standard deviation layer.height_rms. Stationary: the top left part of a larger texture is the smaller
// texture. Each band takes layer.impulses_per_kernel impulses under a kernel, rounded to whole impulses in a
// cell. Throws InputError for a size below 1 x 1, and for periods too small for the layer: where its lobes
// are so narrow that the frequencies which repeat hold less than half of their variance, or more than twice.
// When `progress` asks to stop, the rows not yet made are 0.
std::vector<float> synthesize_texture(const GaborLayer& layer, int width, int height,
                                      const TextureOptions& options = {}, const Progress& progress = {});

}  // namespace astrolith
