#include "recipe/compact/height_predictor_internal.h"

#include <algorithm>

namespace astrolith {
namespace {

constexpr std::int64_t kWholeMemory = 256;
constexpr std::int64_t kWholeWeight = 16384;
constexpr std::int64_t kMostWeight = 4 * kWholeWeight;
constexpr int kSteps = 2;
// The equations start as if the left and the upper pixel had been right, half each, in so many pixels that
// differ by one step of the picture.
constexpr std::int64_t kRidgePixels = 16;

constexpr std::size_t place(std::size_t row, std::size_t column) {
  return row < column ? place(column, row) : row * (row + 1) / 2 + column;
}

}  // namespace

HeightPredictor::HeightPredictor(int width, std::size_t neighbours, int memory, int unit)
    : neighbours_(neighbours),
      memory_(memory),
      ridge_(kRidgePixels * unit * unit),
      above_(static_cast<std::size_t>(width)),
      right_(static_cast<std::size_t>(width)) {
  weights_[0] = weights_[1] = kWholeWeight / 2;
}

void HeightPredictor::start_row() {
  Equations sum;
  for (std::size_t x = above_.size(); x-- > 0;) {
    fade(sum);
    add(above_[x], sum);
    right_[x] = sum;
  }
  left_ = {};
}

int HeightPredictor::predict(int x, const Neighbours& neighbours) {
  Equations equations = left_;
  add(right_[static_cast<std::size_t>(x)], equations);
  for (int step = 0; step < kSteps; ++step) improve_weights(equations);
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < neighbours_; ++i) sum += weights_[i] * neighbours[i];
  return static_cast<int>(sum / kWholeWeight);
}

void HeightPredictor::learn(int x, const Neighbours& neighbours, int height) {
  pass(x);
  add_pixel(neighbours, height, left_);
  add_pixel(neighbours, height, above_[static_cast<std::size_t>(x)]);
}

void HeightPredictor::pass(int x) {
  Equations& above = above_[static_cast<std::size_t>(x)];
  fade(left_);
  add(above, left_);
  fade(above);
}

void HeightPredictor::fade(Equations& equations) const {
  for (std::size_t i = 0; i < place(neighbours_, 0); ++i)
    equations.products[i] = equations.products[i] * memory_ / kWholeMemory;
  for (std::size_t i = 0; i < neighbours_; ++i)
    equations.targets[i] = equations.targets[i] * memory_ / kWholeMemory;
}

void HeightPredictor::add(const Equations& more, Equations& equations) {
  for (std::size_t i = 0; i < more.products.size(); ++i) equations.products[i] += more.products[i];
  for (std::size_t i = 0; i < more.targets.size(); ++i) equations.targets[i] += more.targets[i];
}

void HeightPredictor::add_pixel(const Neighbours& neighbours, int height, Equations& equations) const {
  for (std::size_t i = 0; i < neighbours_; ++i) {
    for (std::size_t j = 0; j <= i; ++j)
      equations.products[place(i, j)] += std::int64_t{neighbours[i]} * neighbours[j];
    equations.targets[i] += std::int64_t{neighbours[i]} * height;
  }
}

void HeightPredictor::improve_weights(const Equations& equations) {
  for (std::size_t i = 0; i < neighbours_; ++i) {
    std::int64_t rest = (equations.targets[i] + (i < 2 ? ridge_ / 2 : 0)) * kWholeWeight;
    for (std::size_t j = 0; j < neighbours_; ++j) {
      if (j != i) rest -= equations.products[place(i, j)] * weights_[j];
    }
    weights_[i] = std::clamp(rest / (equations.products[place(i, i)] + ridge_), -kMostWeight, kMostWeight);
  }
}

}  // namespace astrolith
