// Text and rectangles in pictures, without a library of fonts.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "synthesis/picture/image_file.h"

namespace astrolith {

using PictureInk = std::array<std::uint8_t, 3>;  // sRGB

// Fills what lies within the picture.
void fill_rectangle(RgbaImage16& image, int left, int top, int width, int height, const PictureInk& ink);

// The width of a line of text. A character is 5 x 8 dots, of dot x dot pixels each, and one dot apart from
// the next.
int text_width(std::string_view text, int dot);  // pixels

// Draws printable ASCII; other bytes show as a question mark.
void draw_text(RgbaImage16& image, int left, int top, int dot, std::string_view text, const PictureInk& ink);

}  // namespace astrolith
