#include "numerics/jacobi_rotation.h"

#include <gtest/gtest.h>

namespace astrolith {
namespace {

struct Eigen3 {
  Matrix3 values, vectors = kIdentity3;
};
Eigen3 diagonalised(const Matrix3& m) {
  Eigen3 result{m};
  for (int sweep = 0; sweep < 6; ++sweep) {
    rotate_to_diagonal(result.values, result.vectors, 0, 1);
    rotate_to_diagonal(result.values, result.vectors, 0, 2);
    rotate_to_diagonal(result.values, result.vectors, 1, 2);
  }
  return result;
}

TEST(JacobiRotation, GivesEigenvectors) {
  const Matrix3 m{{{4.0, 1.0, -2.0}, {1.0, 2.0, 0.5}, {-2.0, 0.5, -3.0}}};
  const auto [values, v] = diagonalised(m);
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < 3; ++i) {
      const double product = m[i][0] * v[0][k] + m[i][1] * v[1][k] + m[i][2] * v[2][k];
      EXPECT_NEAR(product, values[k][k] * v[i][k], 1e-14);
      EXPECT_NEAR(v[0][k] * v[0][i] + v[1][k] * v[1][i] + v[2][k] * v[2][i], i == k ? 1.0 : 0.0, 1e-14);
    }
  }
}

// The cotangent of twice the angle is so large here that its square is infinite.
TEST(JacobiRotation, DoesNotOverflow) {
  const auto [values, vectors] = diagonalised({{{1.0, 1e-200, 0.0}, {1e-200, 2.0, 0.0}, {0.0, 0.0, 3.0}}});
  EXPECT_EQ(vectors[0][1], 1e-200);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(values[k][k], static_cast<double>(k + 1));
}

}  // namespace
}  // namespace astrolith
