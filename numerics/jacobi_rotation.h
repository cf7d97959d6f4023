// Jacobi's rotations, which make a symmetric matrix of three rows diagonal.
#pragma once

#include <array>
#include <cmath>

namespace astrolith {

using Matrix3 = std::array<std::array<double, 3>, 3>;

constexpr Matrix3 kIdentity3{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

// Turns rows and columns p and q of a symmetric matrix, after which m[p][q] is 0 but for rounding. Columns p
// and q of `axes` are turned likewise: once they were those of kIdentity3 and the matrix has become diagonal,
// they are its eigenvectors. Six sweeps over the three pairs suffice.
inline void rotate_to_diagonal(Matrix3& m, Matrix3& axes, std::size_t p, std::size_t q) {
  if (m[p][q] == 0.0) return;
  const double theta = (m[q][q] - m[p][p]) / (2.0 * m[p][q]), size = std::fabs(theta);
  const double t = (theta < 0.0 ? -1.0 : 1.0) /
                   (size > 1e150 ? 2.0 * size : size + std::sqrt(theta * theta + 1.0));  // no overflow
  const double c = 1.0 / std::sqrt(t * t + 1.0), s = t * c;
  const auto turn = [c, s](double& a, double& b) {
    const double old = a;
    a = c * old - s * b;
    b = s * old + c * b;
  };
  for (std::size_t k = 0; k < 3; ++k) turn(m[k][p], m[k][q]);
  for (std::size_t k = 0; k < 3; ++k) turn(m[p][k], m[q][k]);
  for (std::size_t k = 0; k < 3; ++k) turn(axes[k][p], axes[k][q]);
}

}  // namespace astrolith
