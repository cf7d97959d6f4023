// How far two histograms lie apart. f and g are frequencies of the same bins: not negative, the sum 1 (or all
// zero: no pairs). All are 0 for equal histograms and symmetric; all throw InputError when sizes differ.
#pragma once

#include <span>
#include <vector>

#include "descriptor/shape_histogram.h"

namespace astrolith {

// |f - g|_2 = sqrt(sum_b (f_b - g_b)^2) in [0, sqrt 2]: the thesis's fitness (4.3.4). A metric.
double l2_distance(std::span<const double> f, std::span<const double> g);

// 1 - |f - g|_2 / sqrt(|f|^2 + |g|^2) in [0, 1]: 1 for equal histograms, 0 for histograms without a common
// bin; 1 when both are zero. Two samplings of one shape differ by 0.01 to 0.04 at some thousand points.
double histogram_similarity(std::span<const double> f, std::span<const double> g);

// (1/2) sum_b (f_b - g_b)^2 / (f_b + g_b) in [0, 1], bins that are empty in both left out: the symmetric
// chi-square distance, 1 without a common bin. Its square root is a metric.
double chi_square_distance(std::span<const double> f, std::span<const double> g);

// sqrt((KL(f | m) + KL(g | m)) / 2) with m = (f + g) / 2 and logarithms to the base 2, in [0, 1]: the
// Jensen-Shannon distance, 1 without a common bin. A metric.
double jensen_shannon_distance(std::span<const double> f, std::span<const double> g);

// Earth mover's distance of two histograms along a line: sum_k |F_k - G_k| / bins with the cumulative sums F
// and G, the work in units of the axis's length. A metric, at most (bins - 1) / bins.
double earth_movers_distance(std::span<const double> f, std::span<const double> g);

// The same around a circle, where the last bin is beside the first: min over c of sum_k |F_k - G_k - c| /
// bins (c is a median), at most 1/2.
double circular_earth_movers_distance(std::span<const double> f, std::span<const double> g);

// (bins) the sums of frequencies (bins, ..., bins) over all axes but one. Throws InputError when the size is
// no power of bins or there is no such axis.
std::vector<double> marginal(std::span<const double> frequencies, int bins, int axis);

// Mean over the axes of the earth mover's distance of the marginals; the first axis, alpha, is a circle.
double marginal_earth_movers_distance(std::span<const double> f, std::span<const double> g, int bins);

struct HistogramDistances {
  double similarity = 1, l2 = 0, chi_square = 0, jensen_shannon = 0, earth_movers = 0;
};

// All of them; earth_movers on the marginals. Throws InputError when features or bins differ.
HistogramDistances histogram_distances(const ShapeHistogram& a, const ShapeHistogram& b);

// histogram_similarity of the frequencies; throws as above.
double similarity(const ShapeHistogram& a, const ShapeHistogram& b);

}  // namespace astrolith
