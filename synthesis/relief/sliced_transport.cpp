#include "synthesis/relief/sliced_transport.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "numerics/cholesky.h"
#include "numerics/hash_random.h"
#include "numerics/host_device.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

using Rows = std::vector<float>;

template <typename Work>
void for_each_index(std::size_t n, const Work& work) {
  parallel_for(0, static_cast<std::int64_t>(n), [&](std::int64_t i) { work(static_cast<std::size_t>(i)); });
}

// y_j = sum_i x_i m_ij of some rows x, each sum in the order of i.
ASTROLITH_SIMD_CLONES void multiply_rows(std::size_t rows, std::size_t columns, const float* x,
                                         const float* m, float* y) {
  for (std::size_t r = 0; r < rows; ++r) {
    float* row = y + r * columns;
    for (std::size_t j = 0; j < columns; ++j) row[j] = 0.0f;
    for (std::size_t i = 0; i < columns; ++i) {
      const float factor = x[r * columns + i];
      const float* of = m + i * columns;
#pragma omp simd
      for (std::size_t j = 0; j < columns; ++j) row[j] += factor * of[j];
    }
  }
}

// x (n x columns) times m (columns x columns).
Rows times(const Rows& x, const Rows& m, std::size_t columns) {
  constexpr std::size_t kTogether = 64;
  const std::size_t n = x.size() / columns;
  Rows y(x.size());
  for_each_index((n + kTogether - 1) / kTogether, [&](std::size_t group) {
    const std::size_t first = group * kTogether * columns;
    multiply_rows(std::min(kTogether, n - group * kTogether), columns, &x[first], m.data(), &y[first]);
  });
  return y;
}

Rows transposed(const Rows& m, std::size_t columns) {
  Rows t(m.size());
  for (std::size_t i = 0; i < columns; ++i) {
    for (std::size_t j = 0; j < columns; ++j) t[j * columns + i] = m[i * columns + j];
  }
  return t;
}

// Random rows made orthonormal by Gram and Schmidt.
Rows rotation(std::size_t columns, std::uint32_t hash) {
  std::vector<std::vector<double>> rows(columns, std::vector<double>(columns));
  for (std::size_t r = 0; r < columns; ++r) {
    std::vector<double>& row = rows[r];
    for (double& value : row) {
      value = -2.0;  // and four uniform numbers: nearly normal
      for (int k = 0; k < 4; ++k) value += double{unit_float(hash = hash_append(hash, 1))};
    }
    for (std::size_t before = 0; before < r; ++before) {
      const double along = std::inner_product(row.begin(), row.end(), rows[before].begin(), 0.0);
      for (std::size_t i = 0; i < columns; ++i) row[i] -= along * rows[before][i];
    }
    const double length = std::sqrt(std::inner_product(row.begin(), row.end(), row.begin(), 0.0));
    for (double& value : row) value /= length;
  }
  Rows all;
  for (const std::vector<double>& row : rows) all.insert(all.end(), row.begin(), row.end());
  return all;
}

std::vector<double> covariance(const Rows& rows, std::size_t columns) {
  const std::size_t n = rows.size() / columns;
  std::vector<double> sums(columns * columns, 0.0);
  for_each_index(columns, [&](std::size_t i) {
    for (std::size_t r = 0; r < n; ++r) {
      const double value = double{rows[r * columns + i]} / static_cast<double>(n);
      for (std::size_t j = 0; j <= i; ++j) sums[i * columns + j] += value * double{rows[r * columns + j]};
    }
  });
  return sums;
}

std::vector<double> inverse_triangle(const std::vector<double>& l, std::size_t columns) {
  std::vector<double> inverse(l.size(), 0.0);
  for (std::size_t c = 0; c < columns; ++c) {
    for (std::size_t i = c; i < columns; ++i) {
      double sum = i == c ? 1.0 : 0.0;
      for (std::size_t k = c; k < i; ++k) sum -= l[i * columns + k] * inverse[k * columns + c];
      inverse[i * columns + c] = sum / l[i * columns + i];
    }
  }
  return inverse;
}

// Replaces the coordinates k of rows by what is missing to the measured ones of the same ranks.
void subtract_from_ranks(const Rows& measured, std::size_t columns, std::size_t k, Rows& rows) {
  const std::size_t n = rows.size() / columns, m = measured.size() / columns;
  std::vector<float> wanted(m);
  for (std::size_t r = 0; r < m; ++r) wanted[r] = measured[r * columns + k];
  std::sort(wanted.begin(), wanted.end());
  std::vector<std::pair<float, std::uint32_t>> order(n);
  for (std::uint32_t r = 0; r < n; ++r) order[r] = {rows[r * columns + k], r};
  std::sort(order.begin(), order.end());
  for (std::size_t rank = 0; rank < n; ++rank) {
    const double share = (static_cast<double>(rank) + 0.5) / static_cast<double>(n);
    const double at = std::clamp(share * static_cast<double>(m) - 0.5, 0.0, static_cast<double>(m - 1));
    const auto below = std::min(static_cast<std::size_t>(at), m - 2);
    const auto t = static_cast<float>(at - static_cast<double>(below));
    rows[order[rank].second * columns + k] =
        (1.0f - t) * wanted[below] + t * wanted[below + 1] - order[rank].first;
  }
}

}  // namespace

SlicedTransport::SlicedTransport(std::vector<float> measured, std::size_t columns, double ridge)
    : columns_(columns), mean_(columns, 0.0f) {
  const std::size_t n = measured.size() / columns;
  for (std::size_t j = 0; j < columns; ++j) {
    double sum = 0.0;
    for (std::size_t r = 0; r < n; ++r) sum += double{measured[r * columns + j]};
    mean_[j] = static_cast<float>(sum / static_cast<double>(n));
  }
  for (std::size_t i = 0; i < measured.size(); ++i) measured[i] -= mean_[i % columns];
  std::vector<double> l = covariance(measured, columns);
  double trace = 0.0;
  for (std::size_t i = 0; i < columns; ++i) trace += l[i * columns + i];
  if (!(trace > 0.0)) return;
  constexpr double kLeast = 1e-9;  // of the trace
  for (std::size_t i = 0; i < columns; ++i) l[i * columns + i] += ridge * l[i * columns + i] + kLeast * trace;
  if (!factor_cholesky(l, columns, 0.0)) return;
  const std::vector<double> inverse = inverse_triangle(l, columns);
  root_.assign(l.begin(), l.end());
  inverse_.assign(inverse.begin(), inverse.end());
  white_ = times(measured, transposed(inverse_, columns), columns);
}

// (rows x columns) R^T (y' - y)
std::vector<float> SlicedTransport::towards(const std::vector<float>& rows,
                                            const std::vector<float>& turn) const {
  Rows white = rows;
  for (std::size_t i = 0; i < white.size(); ++i) white[i] -= mean_[i % columns_];
  Rows y = times(times(white, transposed(inverse_, columns_), columns_), turn, columns_);
  const Rows measured = times(white_, turn, columns_);
  for_each_index(columns_, [&](std::size_t k) { subtract_from_ranks(measured, columns_, k, y); });
  return times(y, transposed(turn, columns_), columns_);
}

std::vector<float> SlicedTransport::changes(const std::vector<float>& rows, std::uint32_t hash) const {
  if (root_.empty()) return Rows(rows.size(), 0.0f);
  return times(towards(rows, rotation(columns_, hash)), transposed(root_, columns_), columns_);
}

std::vector<float> SlicedTransport::gradient(const std::vector<float>& rows, std::uint32_t hash) const {
  if (root_.empty()) return Rows(rows.size(), 0.0f);
  return times(towards(rows, rotation(columns_, hash)), inverse_, columns_);
}

}  // namespace astrolith
