#include "descriptor/histogram_distance.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "numerics/errors.h"
#include "numerics/portable_double.h"
#include "numerics/sample_statistics.h"

namespace astrolith {
namespace {

void check_sizes(std::span<const double> f, std::span<const double> g) {
  if (f.size() != g.size()) {
    throw InputError("histogram distance: " + std::to_string(f.size()) + " bins against " +
                     std::to_string(g.size()) + "; compare histograms of the same features and bins");
  }
}

void check_kinds(const ShapeHistogram& a, const ShapeHistogram& b) {
  if (a.features != b.features || a.bins != b.bins) {
    throw InputError("histogram distance: the histograms have different features or bins; make them alike");
  }
}

// Sum over the bins of term(f_b, g_b).
template <typename Term>
double sum_over_bins(std::span<const double> f, std::span<const double> g, const Term& term) {
  check_sizes(f, g);
  double sum = 0;
  for (std::size_t b = 0; b < f.size(); ++b) sum += term(f[b], g[b]);
  return sum;
}

double squared_distance(std::span<const double> f, std::span<const double> g) {
  return sum_over_bins(f, g, [](double x, double y) { return (x - y) * (x - y); });
}

// x log2(x / mean), which tends to 0 with x.
double entropy_term(double x, double mean) { return x > 0 ? x * portable::log2(x / mean) : 0; }

// The differences F_k - G_k of the cumulative sums.
std::vector<double> cumulative_differences(std::span<const double> f, std::span<const double> g) {
  check_sizes(f, g);
  std::vector<double> sums(f.size());
  double sum = 0;
  for (std::size_t k = 0; k < f.size(); ++k) sums[k] = sum += f[k] - g[k];
  return sums;
}

double mean_distance_from(double c, const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += std::fabs(v - c);
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

int axis_count(std::size_t size, int bins) {
  int axes = 0;
  std::size_t power = 1;
  while (bins > 1 && power < size) {
    power *= static_cast<std::size_t>(bins);
    ++axes;
  }
  if (power != size || axes == 0) {
    throw InputError("marginal: " + std::to_string(size) + " bins are no power of " + std::to_string(bins) +
                     "; give all bins of the histogram");
  }
  return axes;
}

}  // namespace

double l2_distance(std::span<const double> f, std::span<const double> g) {
  return std::sqrt(squared_distance(f, g));
}

double histogram_similarity(std::span<const double> f, std::span<const double> g) {
  const double size2 = sum_over_bins(f, g, [](double x, double y) { return x * x + y * y; });
  return size2 > 0 ? 1 - std::sqrt(squared_distance(f, g) / size2) : 1;
}

double chi_square_distance(std::span<const double> f, std::span<const double> g) {
  return 0.5 *
         sum_over_bins(f, g, [](double x, double y) { return x + y > 0 ? (x - y) * (x - y) / (x + y) : 0; });
}

double jensen_shannon_distance(std::span<const double> f, std::span<const double> g) {
  const double divergence = 0.5 * sum_over_bins(f, g, [](double x, double y) {
                              const double mean = 0.5 * (x + y);
                              return entropy_term(x, mean) + entropy_term(y, mean);
                            });
  return std::sqrt(std::max(divergence, 0.0));
}

double earth_movers_distance(std::span<const double> f, std::span<const double> g) {
  return mean_distance_from(0, cumulative_differences(f, g));
}

double circular_earth_movers_distance(std::span<const double> f, std::span<const double> g) {
  const std::vector<double> differences = cumulative_differences(f, g);
  if (differences.empty()) return 0;
  return mean_distance_from(upper_median(differences), differences);
}

std::vector<double> marginal(std::span<const double> frequencies, int bins, int axis) {
  const int axes = axis_count(frequencies.size(), bins);
  if (axis < 0 || axis >= axes) {
    throw InputError("marginal: axis " + std::to_string(axis) + " is not among " + std::to_string(axes));
  }
  std::size_t stride = 1;
  for (int d = axis + 1; d < axes; ++d) stride *= static_cast<std::size_t>(bins);
  std::vector<double> sums(static_cast<std::size_t>(bins), 0.0);
  for (std::size_t b = 0; b < frequencies.size(); ++b) {
    sums[b / stride % static_cast<std::size_t>(bins)] += frequencies[b];
  }
  return sums;
}

double marginal_earth_movers_distance(std::span<const double> f, std::span<const double> g, int bins) {
  check_sizes(f, g);
  const int axes = axis_count(f.size(), bins);
  double sum = circular_earth_movers_distance(marginal(f, bins, 0), marginal(g, bins, 0));
  for (int d = 1; d < axes; ++d) {
    sum += earth_movers_distance(marginal(f, bins, d), marginal(g, bins, d));
  }
  return sum / axes;
}

HistogramDistances histogram_distances(const ShapeHistogram& a, const ShapeHistogram& b) {
  check_kinds(a, b);
  const std::vector<double> f = a.frequencies(), g = b.frequencies();
  return {histogram_similarity(f, g), l2_distance(f, g), chi_square_distance(f, g),
          jensen_shannon_distance(f, g), marginal_earth_movers_distance(f, g, a.bins)};
}

double similarity(const ShapeHistogram& a, const ShapeHistogram& b) {
  check_kinds(a, b);
  return histogram_similarity(a.frequencies(), b.frequencies());
}

}  // namespace astrolith
