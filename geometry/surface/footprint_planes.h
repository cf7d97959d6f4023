// The plane that fits the ground best, in a square about each pixel of a height map.
#pragma once

#include <vector>

#include "geometry/surface/height_map.h"

namespace astrolith {

// All three are NaN where the square leaves the map or holds a pixel without height.
struct FootprintPlane {
  float along_right = 0.0f, along_ahead = 0.0f;  // rise of the plane, height units for a length unit
  float rms = 0.0f;                              // of the heights about the plane, height units
};

// (side x side) the plane of least squares through the (2 half + 1)^2 heights about each pixel. half >= 1.
std::vector<FootprintPlane> footprint_planes(const HeightMap& map, int half);

}  // namespace astrolith
