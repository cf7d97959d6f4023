// An exemplar: a grey image in memory, some pixels of which may be missing.
#pragma once

#include <cstddef>
#include <vector>

namespace astrolith {

// A grey image of width x height pixels, row-major, the top row first. The full scale of an integer image is
// 1; a float image keeps its values.
struct GreyImage {
  int width = 0;
  int height = 0;
  std::vector<double> values;
  // Where the file has no value (missing_ground.h): a pixel is missing where this is true. Empty: none is. A
  // missing pixel has a value that continues its surroundings smoothly.
  std::vector<bool> missing = {};

  double at(int x, int y) const {
    return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }
  // The pixels of a rectangle that lies inside the image.
  GreyImage part(int left, int top, int part_width, int part_height) const {
    GreyImage result{part_width, part_height, {}};
    result.values.reserve(static_cast<std::size_t>(part_width) * static_cast<std::size_t>(part_height));
    for (int y = top; y < top + part_height; ++y) {
      for (int x = left; x < left + part_width; ++x) result.values.push_back(at(x, y));
    }
    if (missing.empty()) return result;
    for (int y = top; y < top + part_height; ++y) {
      const auto row = missing.begin() + static_cast<std::ptrdiff_t>(y) * width + left;
      result.missing.insert(result.missing.end(), row, row + part_width);
    }
    return result;
  }
  // The square in the middle, or as much of it as there is.
  GreyImage middle(int side) const {
    const int part_width = side < width ? side : width, part_height = side < height ? side : height;
    return part((width - part_width) / 2, (height - part_height) / 2, part_width, part_height);
  }
};

}  // namespace astrolith
