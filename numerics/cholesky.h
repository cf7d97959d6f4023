// Cholesky's factors of small symmetric matrices, row-major, in the order of the textbook: the same bits
// everywhere.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>

namespace astrolith {

// Replaces the lower triangle of an n x n matrix A by L, A = L L^T. False, with the matrix lost, where a
// pivot is not above `least` of its diagonal element.
inline bool factor_cholesky(std::span<double> a, std::size_t n, double least) {
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = a[i * n + j];
      for (std::size_t k = 0; k < j; ++k) sum -= a[i * n + k] * a[j * n + k];
      if (i == j && !(sum > least * a[i * n + i])) return false;
      a[i * n + j] = i == j ? std::sqrt(sum) : sum / a[j * n + j];
    }
  }
  return true;
}

// Replaces x by A^-1 x.
inline void solve_cholesky(std::span<const double> l, std::size_t n, std::span<double> x) {
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) x[i] -= l[i * n + k] * x[k];
    x[i] /= l[i * n + i];
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) x[i] -= l[k * n + i] * x[k];
    x[i] /= l[i * n + i];
  }
}

}  // namespace astrolith
