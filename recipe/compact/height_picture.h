// Pictures of heights in few bits: which pixels have a height, and the heights.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "recipe/compact/range_coder.h"

namespace astrolith {

inline constexpr int kMostHeightPictureSide = 4096;

struct HeightPicture {
  int width = 0, height = 0;          // pixels, 0 .. kMostHeightPictureSide
  std::vector<std::uint16_t> values;  // row by row; 0 is a hole, 1 .. 65535 a height

  std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

void encode(const HeightPicture& picture, RangeEncoder& encoder);

// Throws DamagedStream, also for a picture of more than `most_pixels`. It allocates a row of pixels after it
// has read the rows before, and a few bytes hold less than a million pixels.
HeightPicture decode(std::size_t most_pixels, RangeDecoder& decoder);

}  // namespace astrolith
