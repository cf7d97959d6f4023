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
  static constexpr std::size_t kMostNeighbours = 12;
  using Neighbours = std::array<int, kMostNeighbours>;  // their heights over the mean around a pixel

  // Pixels count by (memory / 256)^d at the distance d in columns or rows. Heights are below 2^16, and a
  // difference of `unit` is one step of the picture.
  HeightPredictor(int width, std::size_t neighbours, int memory, int unit);

  void start_row();
  // The pixels of a row follow each other: predict() for those that have a height, and learn() or pass().
  int predict(int x, const Neighbours& neighbours);
  void learn(int x, const Neighbours& neighbours, int height);
  void pass(int x);

 private:
  // The normal equations, of which the lower triangle is stored.
  struct Equations {
    std::array<std::int64_t, kMostNeighbours*(kMostNeighbours + 1) / 2> products{};
    std::array<std::int64_t, kMostNeighbours> targets{};
  };

  void fade(Equations& equations) const;
  static void add(const Equations& more, Equations& equations);
  void add_pixel(const Neighbours& neighbours, int height, Equations& equations) const;
  void improve_weights(const Equations& equations);

  std::size_t neighbours_;
  std::int64_t memory_;
  std::int64_t ridge_;
  std::array<std::int64_t, kMostNeighbours> weights_{};
  std::vector<Equations> above_;  // of every column, from the rows coded so far
  std::vector<Equations> right_;  // from the rows above, of a column and those right of it
  Equations left_;                // of all columns passed in this row
};

}  // namespace astrolith
