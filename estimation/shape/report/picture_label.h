// Words and scales drawn over the pictures of a report.
#pragma once

#include <string>

#include "synthesis/picture/image_file.h"

namespace astrolith {

// Light text, its baseline's left end at (x, y) pixels.
void draw_label(RgbImage& image, const std::string& text, int x, int y);

// A bar of sequential_color at the upper right, its ends labelled ("0", "0.25 %").
void draw_color_scale(RgbImage& image, const std::string& low, const std::string& high);

}  // namespace astrolith
