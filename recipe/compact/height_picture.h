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

// A picture of more than 2^20 pixels is written as eight bands of rows that know nothing of one another.
void encode(const HeightPicture& picture, RangeEncoder& encoder);

// Throws DamagedStream, also for a picture of more than `most_pixels`. Memory grows with the rows that have
// been read. A byte holds at most 15,200 pixels, and so does each of the kMostZerosLeftOut zeros after the
// last.
HeightPicture decode(std::size_t most_pixels, RangeDecoder& decoder);

}  // namespace astrolith
