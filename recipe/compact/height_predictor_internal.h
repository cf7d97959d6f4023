// Predicts a pixel as a weighted sum of the pixels before it. The weights are those of local least squares,
// as in GLICBAWLS (Meyer and Tischer, "GLICBAWLS: grey level image compression by adaptive weighted least
// squares", 2001), in integer arithmetic: a few steps of Gauss and Seidel from the weights of the pixel
// before stand for the solution of the normal equations.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace astrolith {

class HeightPredictor {
 public:
  static constexpr std::size_t kMostNeighbours = 12, kFewNeighbours = 6;
  using Neighbours = std::array<int, kMostNeighbours>;  // their heights over the mean around a pixel

  // `neighbours` is kMostNeighbours or kFewNeighbours. Pixels count by (memory / 256)^d at the distance d in
  // columns or rows. Heights are below 2^16, and a difference of `unit` is one step of the picture.
  HeightPredictor(int width, std::size_t neighbours, int memory, int unit);

  void start_row();
  // The pixels of a row follow each other: predict() for those that have a height, and learn() or pass().
  int predict(int column, const Neighbours& neighbours);
  void learn(int column, const Neighbours& neighbours, int height);
  void pass(int column);

 private:
  // The normal equations of one place: the lower triangle of the products row by row, then the targets, and
  // zeros up to a whole number of vectors.
  std::int64_t* above(std::size_t x) { return above_.data() + stride_ * x; }
  std::int64_t* right(std::size_t x) { return right_.data() + stride_ * x; }

  std::size_t neighbours_, products_, stride_;
  std::int64_t memory_;
  std::int64_t ridge_;
  std::array<std::int64_t, kMostNeighbours> weights_{};
  std::vector<std::int64_t> above_;  // equations of every column, from the rows coded so far
  std::vector<std::int64_t> right_;  // from the rows above, of a column and those right of it
  std::vector<std::int64_t> left_;   // of all columns passed in this row
  // Whether they hold anything but zeros; those of right_ are not written where they do not. A picture of a
  // body is half holes.
  bool holds_left_ = false;
  std::vector<char> holds_above_, holds_right_;  // of every column
};

}  // namespace astrolith
