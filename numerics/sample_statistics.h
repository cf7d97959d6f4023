// Means, variances, medians and other quantiles of lists of numbers.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace astrolith {

// The mean, and the mean square of the deviations from it; 0 for no numbers.
template <typename T>
double sample_mean(const std::vector<T>& values) {
  double sum = 0.0;
  for (const T v : values) sum += v;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}
template <typename T>
double sample_variance(const std::vector<T>& values) {
  const double mean = sample_mean(values);
  double sum = 0.0;
  for (const T v : values) sum += (v - mean) * (v - mean);
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

// The sum of the products, in the order of the elements; `b` has as many as `a`.
inline double dot_product(std::span<const double> a, std::span<const double> b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

// The value of sorted numbers below which a share of them lies, 0 to 1.
template <typename T>
T sorted_quantile(const std::vector<T>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1) + 0.5)];
}

// The value that stands at `rank` < size once all are sorted.
template <typename T>
T ranked_value(std::vector<T> values, std::size_t rank) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// The median; of an even number of values the upper of the two in the middle. Not empty.
template <typename T>
T upper_median(std::vector<T> values) {
  const std::size_t middle = values.size() / 2;
  return ranked_value(std::move(values), middle);
}

inline double median_magnitude(std::vector<double> values) {
  for (double& v : values) v = std::fabs(v);
  return upper_median(std::move(values));
}

}  // namespace astrolith
