// An exemplar: a grey image in memory.
#pragma once

#include <cstddef>
#include <vector>

namespace astrolith {

// Row-major, width * height values; full scale of integer images is 1, float images keep their values.
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
