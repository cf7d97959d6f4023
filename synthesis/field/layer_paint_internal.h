// The colours of an exemplar layer on the surface of a body. They are computed on the host alone, since a
// mesh needs them once for each vertex, and its heights hundreds of times.
#pragma once

#include <cstdint>
#include <vector>

#include "synthesis/exemplar/exemplar_texture.h"

namespace astrolith {

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

}  // namespace astrolith
