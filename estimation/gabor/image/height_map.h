// What the file of a height map, or of a picture from above, states about its pixels.
#pragma once

#include <string>

namespace astrolith {

struct StatedScale {
  // The sides of a pixel on the ground in metres; 0 where the file states none.
  double pixel_width = 0.0, pixel_height = 0.0;
  bool sheared = false;       // the sides are not perpendicular
  bool like_degrees = false;  // no unit is stated, and the whole map would be most of a globe in degrees
  bool unknown = false;       // PROJ cannot tell the pixels on the ground; the sides are not to be trusted
  std::string pixel_source;   // how metres were found, such as "no unit is stated"; empty for plain metres
  bool heights = false;       // the values are heights in metres, and not brightness
  std::string height_source;  // as pixel_source, of the heights
};

}  // namespace astrolith
