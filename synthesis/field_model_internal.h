// What an ImplicitField and its blocks share.
#pragma once

#include <variant>
#include <vector>

#include "synthesis/fractal_noise.h"
#include "synthesis/gabor_surface_noise.h"
#include "synthesis/metaball_body.h"

namespace astrolith {

using HeightLayer = std::variant<FractalNoise, GaborSurfaceNoise>;

struct FieldModel {
  PreparedMetaballs metaballs;
  std::vector<HeightLayer> layers;  // in the recipe's order
  double height_bound = 0.0;        // of |sum of heights|
  Box bounds;                       // of the surface
};

}  // namespace astrolith
