// The colours that a recipe's layers paint on a plane.
#pragma once

#include <vector>

#include "recipe/recipe.h"
#include "synthesis/gabor/gabor_texture.h"

namespace astrolith {

// The layers that state a colour, in the recipe's order.
std::vector<GaborLayer> colored_layers(const Recipe& recipe);

// RGB at pixel centres, row-major (height x width x 3), full scale = 1, not cut to [0, 1]:
//   color(x) = sum over the layers of (mean + axis * exemplar_rms * noise of unit variance)
// Layer k is drawn from stream options.stream + k. Every layer states a color; their noises are independent,
// so the colours have the exemplar's covariance at each pixel, and each principal axis its own spectrum.
// Throws InputError as synthesize_texture does. When `progress` asks to stop, what is not yet made is
// missing.
std::vector<float> synthesize_color_texture(const std::vector<GaborLayer>& layers, int width, int height,
                                            const TextureOptions& options = {},
                                            const Progress& progress = {});

}  // namespace astrolith
