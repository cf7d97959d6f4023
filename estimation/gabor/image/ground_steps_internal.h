// The pixels of a raster on the ground.
#pragma once

#include <cmath>
#include <optional>
#include <string>

class GDALDataset;

namespace astrolith {

// The steps of a pixel along a row and along a column, in metres on the ground.
struct GroundStep {
  double east = 0.0, north = 0.0;
  double length() const { return std::sqrt(east * east + north * north); }
};
struct GroundSteps {
  GroundStep column, row;
  std::string source;         // StatedScale::pixel_source
  bool like_degrees = false;  // as StatedScale
  bool unknown = false;       // as StatedScale
};

// By the raster's transform and its spatial reference: a grid in degrees by the radius of its body, a
// projected one by its unit of length, or on the ground in the middle of the map where the projection
// stretches it. Unknown where PROJ lacks its data or cannot transform the middle. None where the file states
// no size of pixels.
std::optional<GroundSteps> ground_steps(GDALDataset& raster);

}  // namespace astrolith
