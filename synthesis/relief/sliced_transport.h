// Rows of numbers are moved so that they are distributed as others, along random directions of the space in
// which the others have covariance 1: a step of the sliced Wasserstein distance (Rabin and others,
// Wasserstein barycenter and its application to texture mixing, 2011).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace astrolith {

// With the covariance L L^T of the measured rows and a random rotation R:
//   y = R L^-1 (c - mean),   y'_k = the measured coordinate k with the rank that y_k has among all rows
class SlicedTransport {
 public:
  // (n x columns) Measured rows, of which each variance grows by the share `ridge`. Rows that are all the
  // same want nothing.
  SlicedTransport(std::vector<float> measured, std::size_t columns, double ridge);

  // (rows x columns) L R^T (y' - y): how rows have to change.
  std::vector<float> changes(const std::vector<float>& rows, std::uint32_t hash) const;
  // (rows x columns) L^-T R^T (y' - y): the gradient of -|y' - y|^2 / 2 by the rows.
  std::vector<float> gradient(const std::vector<float>& rows, std::uint32_t hash) const;

 private:
  std::vector<float> towards(const std::vector<float>& rows, const std::vector<float>& rotation) const;

  std::size_t columns_;
  std::vector<float> mean_, root_, inverse_;  // L and L^-1 (columns x columns)
  std::vector<float> white_;                  // the measured rows by L^-1
};

}  // namespace astrolith
