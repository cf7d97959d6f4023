// The colours of an exemplar's image as channels that are not correlated with each other, so that each can be
// Gaussianised and blended by itself.
#pragma once

#include <string>
#include <vector>

#include "recipe/noise_layers.h"

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

}  // namespace astrolith
