// The colours that the layers of a recipe paint on a plane.
#pragma once

#include <vector>

#include "recipe/recipe.h"
#include "synthesis/gabor/gabor_texture.h"

namespace astrolith {

// The layers that state a colour, in the recipe's order.
std::vector<GaborLayer> colored_layers(const Recipe& recipe);

// RGB at pixel centres, row-major (height x width x 3), full scale = 1, not clamped to [0, 1]:
//
//   color(x) = sum over the layers of (mean + axis * exemplar_rms * noise of unit variance)
//
// Layer k is drawn from stream options.stream + k, so that the noises of the layers are independent. The
// colours therefore have the covariance of the exemplar at each pixel, and each principal axis has its own
// spectrum. Every layer must have a colour. Throws InputError as synthesize_texture does. When `progress`
// asks to stop, the noise not yet made is 0.
std::vector<float> synthesize_color_texture(const std::vector<GaborLayer>& layers, int width, int height,
                                            const TextureOptions& options = {},
                                            const Progress& progress = {});

}  // namespace astrolith
