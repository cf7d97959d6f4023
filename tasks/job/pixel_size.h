// Sizes of pictures and textures on the command line: WxH.
#pragma once

#include <cstdio>
#include <string>

#include "numerics/errors.h"

namespace astrolith {

struct PixelSize {
  int width, height;
};

// Reads "1024x768". Throws InputError that names the option unless both sides are within the limits.
inline PixelSize parse_pixel_size(const std::string& option, const std::string& text, int least, int most) {
  PixelSize size{};
  char cross = 0, rest = 0;
  const int fields = std::sscanf(text.c_str(), "%6d%c%6d%c", &size.width, &cross, &size.height, &rest);
  const auto fits = [&](int side) { return side >= least && side <= most; };
  if (fields == 3 && (cross == 'x' || cross == 'X') && fits(size.width) && fits(size.height)) return size;
  throw InputError(option + ": \"" + text + "\" is not a size; write WxH with sides of " +
                   std::to_string(least) + " to " + std::to_string(most) + ", such as 1024x1024");
}

}  // namespace astrolith
