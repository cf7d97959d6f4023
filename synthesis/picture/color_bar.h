// A bar that says which colour stands for which number.
#pragma once

#include <string>

#include "synthesis/picture/image_file.h"

namespace astrolith {

// Adds a strip below the picture with the colours of sequential_color() from `low` at the left to `high` at
// the right, and both numbers below them, to four digits. Does nothing to pictures under 160 x 120 pixels.
void add_color_bar(RgbImage& image, double low, double high);

}  // namespace astrolith
