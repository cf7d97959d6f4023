// An exemplar: a grey image in memory.
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

  double at(int x, int y) const {
    return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }
};

}  // namespace astrolith
