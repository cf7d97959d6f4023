// A picture with a margin on three sides, so that pixels already coded can be read around every pixel.
#pragma once

#include <cstddef>
#include <vector>

namespace astrolith {

template <class T>
class PaddedGrid {
 public:
  static constexpr int kMargin = 3;  // pixels left, right and above

  PaddedGrid(int width, int height, T value)
      : stride_(width + 2 * kMargin),
        values_(static_cast<std::size_t>(stride_) * (height + kMargin), value) {}

  T& at(int x, int y) { return values_[index(x, y)]; }
  T at(int x, int y) const { return values_[index(x, y)]; }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y + kMargin) * static_cast<std::size_t>(stride_) +
           static_cast<std::size_t>(x + kMargin);
  }

  int stride_;
  std::vector<T> values_;
};

}  // namespace astrolith
