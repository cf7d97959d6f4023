#include "descriptor/histogram_distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "numerics/errors.h"
#include "numerics/hash_random.h"

namespace astrolith {
namespace {

using Histogram = std::vector<double>;

Histogram random_histogram(CounterRandom& random, std::size_t size) {
  Histogram f(size);
  for (double& v : f) v = random.uniform() < 0.3 ? 0 : random.uniform();
  const double sum = std::accumulate(f.begin(), f.end(), 0.0);
  for (double& v : f) v /= sum;
  return f;
}

using Distance = double (*)(std::span<const double>, std::span<const double>);
double root_chi_square(std::span<const double> f, std::span<const double> g) {
  return std::sqrt(chi_square_distance(f, g));
}
double of_marginals(std::span<const double> f, std::span<const double> g) {
  return marginal_earth_movers_distance(f, g, 3);
}

TEST(HistogramDistance, Metrics) {
  CounterRandom random(1);
  for (int k = 0; k < 300; ++k) {
    const Histogram f = random_histogram(random, 81), g = random_histogram(random, 81),
                    h = random_histogram(random, 81);
    for (const Distance d : {&l2_distance, &root_chi_square, &jensen_shannon_distance, &earth_movers_distance,
                             &circular_earth_movers_distance, &of_marginals}) {
      EXPECT_NEAR(d(f, f), 0, 1e-8);
      EXPECT_GT(d(f, g), 0);
      EXPECT_NEAR(d(f, g), d(g, f), 1e-15);
      EXPECT_LE(d(f, h), d(f, g) + d(g, h) + 1e-12);
    }
  }
}

TEST(HistogramDistance, WithoutACommonBin) {
  const Histogram f = {1, 0, 0}, g = {0, 1, 0};
  EXPECT_DOUBLE_EQ(histogram_similarity(f, g), 0);
  EXPECT_DOUBLE_EQ(l2_distance(f, g), std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(chi_square_distance(f, g), 1);
  EXPECT_DOUBLE_EQ(jensen_shannon_distance(f, g), 1);
  EXPECT_DOUBLE_EQ(earth_movers_distance(f, g), 1.0 / 3);
}

TEST(HistogramDistance, ByHand) {
  const Histogram f = {1, 0, 0}, h = {0.5, 0.5, 0};
  EXPECT_DOUBLE_EQ(histogram_similarity(f, h), 1 - std::sqrt(0.5 / 1.5));
  EXPECT_DOUBLE_EQ(l2_distance(f, h), std::sqrt(0.5));
  EXPECT_DOUBLE_EQ(chi_square_distance(f, h), 0.5 * (0.25 / 1.5 + 0.25 / 0.5));
  EXPECT_NEAR(jensen_shannon_distance(f, h),
              std::sqrt(0.5 * (std::log2(1 / 0.75) + 0.5 * std::log2(0.5 / 0.75) + 0.5 * std::log2(2))),
              1e-15);
  EXPECT_DOUBLE_EQ(earth_movers_distance(f, h), 0.5 / 3);
  EXPECT_DOUBLE_EQ(histogram_similarity(Histogram(3), Histogram(3)), 1);
  EXPECT_EQ(jensen_shannon_distance(Histogram(3), Histogram(3)), 0);
  EXPECT_EQ(chi_square_distance(Histogram(3), Histogram(3)), 0);
}

TEST(HistogramDistance, AroundACircleTheShorterWay) {
  Histogram f(10), g(10);
  f[0] = g[9] = 1;
  EXPECT_DOUBLE_EQ(earth_movers_distance(f, g), 0.9);
  EXPECT_DOUBLE_EQ(circular_earth_movers_distance(f, g), 0.1);
  g[9] = 0;
  g[5] = 1;
  EXPECT_DOUBLE_EQ(circular_earth_movers_distance(f, g), 0.5);
  // Turning both histograms by the same angle changes nothing.
  CounterRandom random(2);
  const Histogram a = random_histogram(random, 10), b = random_histogram(random, 10);
  Histogram c = a, d = b;
  std::rotate(c.begin(), c.begin() + 3, c.end());
  std::rotate(d.begin(), d.begin() + 3, d.end());
  EXPECT_NEAR(circular_earth_movers_distance(a, b), circular_earth_movers_distance(c, d), 1e-15);
}

TEST(HistogramDistance, Marginals) {
  Histogram f(81);  // three bins, four axes
  f[27 * 2 + 9 * 1 + 3 * 0 + 2] = 0.75;
  f[27 * 2 + 9 * 0 + 3 * 1 + 2] = 0.25;
  EXPECT_EQ(marginal(f, 3, 0), (Histogram{0, 0, 1}));
  EXPECT_EQ(marginal(f, 3, 1), (Histogram{0.25, 0.75, 0}));
  EXPECT_EQ(marginal(f, 3, 2), (Histogram{0.75, 0.25, 0}));
  EXPECT_EQ(marginal(f, 3, 3), (Histogram{0, 0, 1}));
  Histogram g = f;
  std::swap(g[27 * 2 + 9 * 1 + 2], g[27 * 2 + 9 * 1 + 0]);  // 0.75 by two bins along the last axis
  EXPECT_DOUBLE_EQ(marginal_earth_movers_distance(f, g, 3), 0.75 * 2 / 3 / 4);
}

TEST(HistogramDistance, WrongInput) {
  const Histogram f(625), g(624);
  for (const Distance d :
       {&l2_distance, &histogram_similarity, &chi_square_distance, &jensen_shannon_distance,
        &earth_movers_distance, &circular_earth_movers_distance}) {
    EXPECT_THROW(d(f, g), InputError);
  }
  EXPECT_THROW(marginal(g, 5, 0), InputError);
  EXPECT_THROW(marginal(f, 5, 4), InputError);
  EXPECT_THROW(marginal(f, 5, -1), InputError);
  EXPECT_THROW(marginal(Histogram(1), 5, 0), InputError);
  ShapeHistogram wahl{PairFeatures::wahl, 5, std::vector<std::uint64_t>(625), 0, 0};
  ShapeHistogram coarse{PairFeatures::wahl, 3, std::vector<std::uint64_t>(81), 0, 0};
  EXPECT_THROW(similarity(wahl, coarse), InputError);
  EXPECT_THROW(histogram_distances(wahl, coarse), InputError);
  EXPECT_EQ(histogram_distances(wahl, wahl).similarity, 1);
}

}  // namespace
}  // namespace astrolith
