// The colours of an exemplar's image as channels that are not correlated with each other, so that each can be
// Gaussianised and blended by itself. They are computed on the host alone, since a mesh needs them once for
// each vertex, and its heights hundreds of times.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "recipe/noise_layers.h"
#include "synthesis/exemplar/exemplar_texture.h"

namespace astrolith {

// A principal axis of the colours. `layer` has the image's values along the axis as its pixels, and its
// heights are these values less their mean, full scale = 1.
struct ColorChannel {
  ExemplarLayer layer;
  Vec3d axis;  // unit vector; red, green, blue
};

// color = mean + sum over the channels of axis * height of the channel's layer. The axis of the largest
// variance is the first. A channel whose standard deviation is below 1e-4 is left out.
struct ExemplarColors {
  Vec3d mean;  // full scale = 1
  std::vector<ColorChannel> channels;
};

// The channels of a layer's image. A grey image has one channel, along (1, 1, 1). Throws InputError, which
// begins with `place`, where the layer has no pixels.
ExemplarColors exemplar_colors(const ExemplarLayer& layer, const std::string& place);

// A principal axis of the colours. The heights of the texture are values along the axis, full scale = 1.
struct PaintChannel {
  ExemplarTexture texture;
  Vec3f axis;  // red, green, blue
};

// What a layer paints: color = mean + sum over the channels of axis * height.
struct LayerPaint {
  std::uint32_t layer = 0;  // number of the layer in the field's tables; it is an ExemplarNoise
  ArrayView arrays;         // of the textures
  Vec3f mean;               // full scale = 1
  std::vector<PaintChannel> channels;
};

// What a layer with a colour paints on a body. Its textures are added to `textures`.
LayerPaint make_exemplar_paint(const ExemplarLayer& layer, const std::string& place, ArrayStore& textures);

}  // namespace astrolith
