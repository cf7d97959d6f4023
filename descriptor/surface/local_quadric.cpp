#include "descriptor/surface/local_quadric.h"

#include <cmath>

namespace astrolith {
namespace {

constexpr int kTerms = 6;
using Row = std::array<double, kTerms>;
using Square = std::array<Row, kTerms>;

// The normal equations of the least-squares problem: the lower half of the matrix, and the right side.
struct NormalEquations {
  Square matrix{};
  Row right{};

  void add(const Vec3d& p) {
    const Row terms{1.0, p.x, p.y, p.x * p.x, p.x * p.y, p.y * p.y};
    for (std::size_t i = 0; i < kTerms; ++i) {
      for (std::size_t j = 0; j <= i; ++j) matrix[i][j] += terms[i] * terms[j];
      right[i] += terms[i] * p.z;
    }
  }
};

// Replaces the matrix by its Cholesky factor L, matrix = L L^T. False where a pivot is lost to rounding.
bool factorise(Square& a) {
  constexpr double kLeastPivot = 1e-10;  // of the diagonal element
  for (std::size_t j = 0; j < kTerms; ++j) {
    double pivot = a[j][j];
    for (std::size_t k = 0; k < j; ++k) pivot -= a[j][k] * a[j][k];
    if (!(pivot > kLeastPivot * a[j][j])) return false;
    a[j][j] = std::sqrt(pivot);
    for (std::size_t i = j + 1; i < kTerms; ++i) {
      double sum = a[i][j];
      for (std::size_t k = 0; k < j; ++k) sum -= a[i][k] * a[j][k];
      a[i][j] = sum / a[j][j];
    }
  }
  return true;
}

Row solved(const Square& factor, Row x) {
  for (std::size_t i = 0; i < kTerms; ++i) {
    for (std::size_t k = 0; k < i; ++k) x[i] -= factor[i][k] * x[k];
    x[i] /= factor[i][i];
  }
  for (std::size_t i = kTerms; i-- > 0;) {
    for (std::size_t k = i + 1; k < kTerms; ++k) x[i] -= factor[k][i] * x[k];
    x[i] /= factor[i][i];
  }
  return x;
}

}  // namespace

std::optional<LocalQuadric> fit_quadric(std::span<const Vec3d> points) {
  if (points.size() < kTerms) return std::nullopt;
  NormalEquations equations;
  for (const Vec3d& p : points) equations.add(p);
  if (!factorise(equations.matrix)) return std::nullopt;
  return LocalQuadric{solved(equations.matrix, equations.right)};
}

ResidualMoments residual_moments(std::span<const double> residuals, double negligible) {
  double second = 0.0, third = 0.0, fourth = 0.0;
  for (const double r : residuals) {
    const double square = r * r;
    second += square;
    third += square * r;
    fourth += square * square;
  }
  const auto n = static_cast<double>(residuals.size());
  ResidualMoments moments;
  moments.rms = std::sqrt(second / (n - kTerms));
  if (moments.rms < negligible) return moments;
  const double variance = second / n;
  moments.skewness = third / n / (variance * std::sqrt(variance));
  moments.kurtosis = fourth / n / (variance * variance) - 3.0;
  return moments;
}

}  // namespace astrolith
