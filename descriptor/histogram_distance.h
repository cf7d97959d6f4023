// Distances between two histograms. f and g are frequencies of the same bins: not negative, with the sum 1,
// or all zero where there are no pairs. Every distance is symmetric and 0 for equal histograms, and throws
// InputError when the sizes differ.
#pragma once

#include <span>
#include <vector>

#include "descriptor/shape_histogram.h"

namespace astrolith {

// |f - g|_2 = sqrt(sum_b (f_b - g_b)^2) in [0, sqrt 2], the fitness of the thesis (4.3.4). It is a metric.
double l2_distance(std::span<const double> f, std::span<const double> g);

// 1 - |f - g|_2 / sqrt(|f|^2 + |g|^2) in [0, 1]. Equal histograms give 1, as do two histograms of zeros;
// histograms without a common bin give 0. Two samplings of one shape with some thousand points differ by 0.01
// to 0.04.
double histogram_similarity(std::span<const double> f, std::span<const double> g);

// The symmetric chi-square distance (1/2) sum_b (f_b - g_b)^2 / (f_b + g_b) in [0, 1]. Bins that are empty in
// both histograms are left out. Histograms without a common bin give 1. Its square root is a metric.
double chi_square_distance(std::span<const double> f, std::span<const double> g);

// The Jensen-Shannon distance sqrt((KL(f | m) + KL(g | m)) / 2) in [0, 1], with m = (f + g) / 2 and
// logarithms to the base 2. Histograms without a common bin give 1. It is a metric.
double jensen_shannon_distance(std::span<const double> f, std::span<const double> g);

// The earth mover's distance of two histograms along a line, sum_k |F_k - G_k| / bins with the cumulative
// sums F and G: the work in units of the length of the axis. It is a metric and at most (bins - 1) / bins.
double earth_movers_distance(std::span<const double> f, std::span<const double> g);

// The earth mover's distance around a circle, where the last bin is beside the first: the minimum over c of
// sum_k |F_k - G_k - c| / bins, which a median c reaches. It is at most 1/2.
double circular_earth_movers_distance(std::span<const double> f, std::span<const double> g);

// (bins) the frequencies (bins, ..., bins), summed over all axes but one. Throws InputError when the size is
// no power of bins or the axis does not exist.
std::vector<double> marginal(std::span<const double> frequencies, int bins, int axis);

// The mean over the axes of the earth mover's distance between the marginals. The first axis, alpha, is a
// circle.
double marginal_earth_movers_distance(std::span<const double> f, std::span<const double> g, int bins);

struct HistogramDistances {
  double similarity = 1, l2 = 0, chi_square = 0, jensen_shannon = 0, earth_movers = 0;
};

// All distances between two histograms; earth_movers is marginal_earth_movers_distance. Throws InputError
// when features or bins differ.
HistogramDistances histogram_distances(const ShapeHistogram& a, const ShapeHistogram& b);

// histogram_similarity of the frequencies. Throws as histogram_distances does.
double similarity(const ShapeHistogram& a, const ShapeHistogram& b);

}  // namespace astrolith
