// How bright the ground is: normal albedo, the light that comes back under a sun behind the viewer over that
// of a white Lambert disk (I/F at a phase angle of 0). Include recipe/recipe.h, which includes this file.
//
// At a point of the surface the albedo of a channel is C exp(t). C is that of the ground, which layers blend
// others over with their weights (mask, locality). t adds up what the fields here call factors. A `color` is
// the share of the normal albedo in red, green and blue light (primaries of sRGB).
#pragma once

#include <optional>

#include "numerics/vec3.h"

namespace astrolith {

// Ground at low places is covered by settled dust: the factor where elevations reach `to`, 1 at `from`, with
// t^2 (3 - 2 t) between them.
struct AlbedoByElevation {
  double from = 0.0, to = -1.0;  // length units above the bare body; different
  double factor = 1.0;           // [0.1, 10]
};

// The ground of a body.
struct GroundAlbedo {
  double normal = 0.1;   // [1e-3, 1]
  Vec3d color{1, 1, 1};  // each in [0, 4]
  double steep = 1.0;    // factor on a slope of 45 degrees against the bare body, [0.1, 10]: t ~ 1 - cos
  std::optional<AlbedoByElevation> elevation = std::nullopt;

  // Multiplies all lengths by the ratio.
  void rescale(double ratio) {
    if (!elevation) return;
    elevation->from *= ratio;
    elevation->to *= ratio;
  }
};

// What a layer of noise does to the ground. With `normal` it covers the ground by its weight; `contrast` adds
// contrast * height / (the layer's stated height) to t, times the weight.
struct LayerAlbedo {
  std::optional<double> normal = std::nullopt;  // [1e-3, 1]; absent: the ground keeps its own
  Vec3d color{1, 1, 1};                         // of `normal`; each in [0, 4]
  double contrast = 0.0;                        // [-5, 5]
};

// What craters do: the factor of the youngest, which falls to 1 with age / greatest_age. It is full within
// the rim, and falls off with ((extent - x) / (extent - 1))^2 beyond. Younger craters cover what older ones
// did.
struct CraterAlbedo {
  double fresh = 1.0;    // [0.1, 10]
  Vec3d color{1, 1, 1};  // factors of the channels, beside `fresh`; each in [0.1, 10]
};

// Boulders, each of one albedo: normal * exp(spread * a normal number), and `bright` times that for some.
struct BoulderAlbedo {
  double normal = 0.1;        // the median, [1e-3, 1]
  double spread = 0.0;        // of the logarithm, [0, 2]
  double bright_share = 0.0;  // of the boulders, [0, 1]
  double bright = 1.0;        // their factor, [0.1, 10]
  Vec3d color{1, 1, 1};       // each in [0, 4]
};

}  // namespace astrolith
