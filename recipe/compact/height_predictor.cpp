#include "recipe/compact/height_predictor_internal.h"

#include <algorithm>

#include "numerics/host_device.h"

namespace astrolith {
namespace {

constexpr std::int64_t kWholeMemory = 256;
constexpr std::int64_t kWholeWeight = 16384;
constexpr std::int64_t kMostWeight = 4 * kWholeWeight;
constexpr int kSteps = 2;
// The equations start as if the left and the upper pixel had been right, half each, in so many pixels that
// differ by one step of the picture.
constexpr std::int64_t kRidgePixels = 16;
constexpr std::size_t kVector = 8;       // numbers
constexpr std::size_t kMostStride = 96;  // of equations

constexpr std::size_t place(std::size_t row, std::size_t column) {
  return row < column ? place(column, row) : row * (row + 1) / 2 + column;
}

// The arrays below hold equations of n numbers, a whole number of vectors.
ASTROLITH_SIMD_CLONES void add(const std::int64_t* __restrict a, const std::int64_t* __restrict b,
                               std::size_t n, std::int64_t* __restrict sum) {
  for (std::size_t i = 0; i < n; ++i) sum[i] = a[i] + b[i];
}

// sum = fade(sum) + more; copy = sum. Returns whether any of them is not 0.
ASTROLITH_SIMD_CLONES bool fade_and_add(const std::int64_t* __restrict more, std::size_t n,
                                        std::int64_t memory, std::int64_t* __restrict sum,
                                        std::int64_t* __restrict copy) {
  std::int64_t any = 0;
  for (std::size_t i = 0; i < n; ++i) {
    copy[i] = sum[i] = sum[i] * memory / kWholeMemory + more[i];
    any |= sum[i];
  }
  return any != 0;
}

// left = fade(left) + above; above = fade(above). Returns whether any number above is not 0.
ASTROLITH_SIMD_CLONES bool pass_column(std::size_t n, std::int64_t memory, std::int64_t* __restrict left,
                                       std::int64_t* __restrict above) {
  std::int64_t any = 0;
  for (std::size_t i = 0; i < n; ++i) {
    left[i] = left[i] * memory / kWholeMemory + above[i];
    above[i] = above[i] * memory / kWholeMemory;
    any |= above[i];
  }
  return any != 0;
}

// left = fade(left). Returns whether any number of it is not 0.
ASTROLITH_SIMD_CLONES bool fade(std::size_t n, std::int64_t memory, std::int64_t* __restrict left) {
  std::int64_t any = 0;
  for (std::size_t i = 0; i < n; ++i) {
    left[i] = left[i] * memory / kWholeMemory;
    any |= left[i];
  }
  return any != 0;
}

// Fades both sums, adds the equations of a pixel to both, and those above to the left.
ASTROLITH_SIMD_CLONES void learn_column(const std::int64_t* __restrict pixel, std::size_t n,
                                        std::int64_t memory, std::int64_t* __restrict left,
                                        std::int64_t* __restrict above) {
  for (std::size_t i = 0; i < n; ++i) {
    left[i] = left[i] * memory / kWholeMemory + above[i] + pixel[i];
    above[i] = above[i] * memory / kWholeMemory + pixel[i];
  }
}

// A step of Gauss and Seidel. The loops have a constant length, so that every place in the equations is
// known.
template <std::size_t kNeighbours>
void improve_weights(const std::int64_t* equations, std::int64_t ridge, std::int64_t* weights) {
  constexpr std::size_t kProducts = place(kNeighbours, 0);
  ASTROLITH_UNROLL
  for (std::size_t i = 0; i < kNeighbours; ++i) {
    std::int64_t rest = (equations[kProducts + i] + (i < 2 ? ridge / 2 : 0)) * kWholeWeight;
    ASTROLITH_UNROLL
    for (std::size_t j = 0; j < kNeighbours; ++j) {
      if (j != i) rest -= equations[place(i, j)] * weights[j];
    }
    weights[i] = std::clamp(rest / (equations[place(i, i)] + ridge), -kMostWeight, kMostWeight);
  }
}

}  // namespace

HeightPredictor::HeightPredictor(int width, std::size_t neighbours, int memory, int unit)
    : neighbours_(neighbours),
      products_(place(neighbours, 0)),
      stride_((products_ + neighbours + kVector - 1) / kVector * kVector),
      memory_(memory),
      ridge_(kRidgePixels * unit * unit),
      above_(stride_ * static_cast<std::size_t>(width)),
      right_(stride_ * static_cast<std::size_t>(width)),
      left_(stride_),
      holds_above_(static_cast<std::size_t>(width), 0),
      holds_right_(static_cast<std::size_t>(width), 0) {
  weights_[0] = weights_[1] = kWholeWeight / 2;
}

void HeightPredictor::start_row() {
  std::fill(left_.begin(), left_.end(), 0);
  bool any = false;
  for (std::size_t x = holds_above_.size(); x-- > 0;) {
    any = any || holds_above_[x] != 0;
    if (any) any = fade_and_add(above(x), stride_, memory_, left_.data(), right(x));
    holds_right_[x] = any ? 1 : 0;
  }
  std::fill(left_.begin(), left_.end(), 0);
  holds_left_ = false;
}

int HeightPredictor::predict(int column, const Neighbours& neighbours) {
  const auto x = static_cast<std::size_t>(column);
  std::array<std::int64_t, kMostStride> equations;
  if (holds_right_[x] != 0) {
    add(left_.data(), right(x), stride_, equations.data());
  } else {
    std::copy(left_.begin(), left_.end(), equations.begin());
  }
  for (int step = 0; step < kSteps; ++step) {
    if (neighbours_ == kMostNeighbours) {
      improve_weights<kMostNeighbours>(equations.data(), ridge_, weights_.data());
    } else {
      improve_weights<kFewNeighbours>(equations.data(), ridge_, weights_.data());
    }
  }
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < neighbours_; ++i) sum += weights_[i] * neighbours[i];
  return static_cast<int>(sum / kWholeWeight);
}

void HeightPredictor::learn(int column, const Neighbours& neighbours, int height) {
  std::array<std::int64_t, kMostStride> pixel{};
  for (std::size_t i = 0; i < neighbours_; ++i) {
    for (std::size_t j = 0; j <= i; ++j) pixel[place(i, j)] = std::int64_t{neighbours[i]} * neighbours[j];
    pixel[products_ + i] = std::int64_t{neighbours[i]} * height;
  }
  const auto x = static_cast<std::size_t>(column);
  learn_column(pixel.data(), stride_, memory_, left_.data(), above(x));
  holds_left_ = true, holds_above_[x] = 1;
}

void HeightPredictor::pass(int column) {
  const auto x = static_cast<std::size_t>(column);
  if (holds_above_[x] != 0) {
    holds_above_[x] = pass_column(stride_, memory_, left_.data(), above(x)) ? 1 : 0;
    holds_left_ = true;
  } else if (holds_left_) {
    holds_left_ = fade(stride_, memory_, left_.data());
  }
}

}  // namespace astrolith
