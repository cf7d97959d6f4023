// Gabor layers of a recipe on a plane, and the colours that they paint there.
#pragma once

#include <vector>

#include "recipe/recipe.h"
#include "synthesis/gabor/gabor_texture.h"
#include "synthesis/noise/plane_texture.h"

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

PlaneTexture heights_on_plane(const GaborLayer& layer, const PlaneDrawing& drawing);
// The colours of all Gabor layers that have one, since each has only one axis of an image's colours.
PlaneTexture colors_on_plane(const GaborLayer& layer, const PlaneDrawing& drawing);

}  // namespace astrolith
