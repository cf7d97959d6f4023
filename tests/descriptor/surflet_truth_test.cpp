// Compares the bins of independent pairs with closed forms. The counts are then multinomial, and Pearson's
// chi-square says how large their deviations may be.
#include <array>
#include <functional>
#include <numbers>

#include "descriptor/surflet_pair.h"
#include "tests/descriptor/surflets.h"

namespace astrolith {
namespace {

using namespace testing;

constexpr int kPairs = 200000;

struct OrientedPoint {
  Vec3d point, normal;
};

int bin_of(const OrientedPoint& i, const OrientedPoint& j) {
  const auto single = [](const OrientedPoint& s) {
    const auto f = [](const Vec3d& v) {
      return Vec3f{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
    };
    return surflet(f(s.point), f(s.normal));
  };
  return surflet_code<5>(single(i), single(j)) % 625;
}

int truth_code(int alpha, int beta, int gamma, int delta) {
  return ((alpha * 5 + beta) * 5 + gamma) * 5 + delta;
}

// Compares counts with expectations bin by bin. A statistic more than four standard deviations above its mean
// would be no chance.
void expect_frequencies(const std::vector<double>& expected,
                        const std::function<OrientedPoint(CounterRandom&)>& point) {
  CounterRandom random(11);
  std::vector<double> counts(625, 0.0);
  for (int k = 0; k < kPairs; ++k) {
    const OrientedPoint i = point(random), j = point(random);
    ++counts[static_cast<std::size_t>(bin_of(i, j))];
  }
  double statistic = 0, sum = 0;
  int bins = 0;
  for (std::size_t b = 0; b < 625; ++b) {
    sum += expected[b];
    if (expected[b] * kPairs < 5) {
      EXPECT_LT(counts[b], 30) << b;
      continue;
    }
    ++bins;
    statistic += std::pow(counts[b] - expected[b] * kPairs, 2) / (expected[b] * kPairs);
  }
  EXPECT_NEAR(sum, 1, 1e-12);
  EXPECT_LT(statistic, bins + 4 * std::sqrt(2.0 * bins)) << bins << " bins";
}

// Adds to each bin its share of a distribution of lengths. `distribution` is cumulative, and the bin changes
// at given lengths.
void add_shares(double share, std::vector<double> borders, const std::function<double(double)>& distribution,
                const std::function<int(double)>& bin_at, std::vector<double>& expected) {
  std::sort(borders.begin(), borders.end());
  for (std::size_t k = 0; k + 1 < borders.size(); ++k) {
    const double low = borders[k], high = borders[k + 1];
    expected[static_cast<std::size_t>(bin_at(0.5 * (low + high)))] +=
        share * (distribution(high) - distribution(low));
  }
}

int fifth(double unit) { return std::clamp(static_cast<int>(std::floor((unit + 1) / 2 * 5)), 0, 4); }

// On a sphere alpha = theta, beta = 0, gamma = -delta and delta = sin(theta / 2), whose square is uniform.
TEST(SurfletTruth, Sphere) {
  std::vector<double> expected(625, 0.0);
  add_shares(
      1, {0, 0.2, 0.4, 0.6, 0.8, std::sin(std::numbers::pi / 10), std::sin(3 * std::numbers::pi / 10), 1},
      [](double d) { return d * d; },
      [](double d) {
        return truth_code(fifth(2 * std::asin(d) / std::numbers::pi), 2, fifth(-d), fifth(2 * d - 1));
      },
      expected);
  expect_frequencies(expected, [](CounterRandom& random) {
    const Vec3d n = random_direction(random);
    return OrientedPoint{0.5 * n, n};
  });
}

// The cumulative distribution of the distance between two random points of the unit square.
double square_distribution(double d) {
  const double d2 = d * d;
  if (d <= 1) return d2 * (std::numbers::pi + d2 / 2) - 8 * d * d2 / 3;
  if (d >= std::sqrt(2.0)) return 1;
  return 1.0 / 3 - 2 * d2 - d2 * d2 / 2 + 4.0 / 3 * std::sqrt(d2 - 1) * (2 * d2 + 1) +
         2 * d2 * (std::asin(1 / d) - std::acos(1 / d));
}

// In a plane all angles are 0; only the distances differ.
TEST(SurfletTruth, PlanePatch) {
  const double side = 1 / std::sqrt(2.0);
  std::vector<double> expected(625, 0.0);
  add_shares(
      1, {0, 0.2, 0.4, 0.6, 0.8, 1}, [&](double d) { return square_distribution(d / side); },
      [](double d) { return truth_code(2, 2, 2, fifth(2 * d - 1)); }, expected);
  expect_frequencies(expected, [&](CounterRandom& random) {
    return OrientedPoint{{side * (random.uniform() - 0.5), side * (random.uniform() - 0.5), 0}, {0, 0, 1}};
  });
}

// Two squares at distance h look away from each other. Half of the pairs lie within one square. The other
// pairs, at distance t along the squares, have alpha = pi, beta = 0, gamma = -h / sqrt(h^2 + t^2).
TEST(SurfletTruth, TwoParallelPlanes) {
  const double h = 0.3, side = std::sqrt((1 - h * h) / 2);
  const auto along = [&](double length) { return std::sqrt(std::max(length * length - h * h, 0.0)); };
  const auto distribution = [&](double t) { return square_distribution(t / side); };
  std::vector<double> expected(625, 0.0);
  const double diagonal = side * std::sqrt(2.0);
  add_shares(
      0.5, {0, 0.2, 0.4, 0.6, 0.8, diagonal}, distribution,
      [](double t) { return truth_code(2, 2, 2, fifth(2 * t - 1)); }, expected);
  add_shares(
      0.5, {0, along(0.4), along(0.6), along(0.8), along(h / 0.6), diagonal}, distribution,
      [&](double t) {
        const double length = std::hypot(h, t);
        return truth_code(4, 2, fifth(-h / length), fifth(2 * length - 1));
      },
      expected);
  expect_frequencies(expected, [&](CounterRandom& random) {
    const double up = random.uniform() < 0.5 ? 1 : -1;
    return OrientedPoint{{side * (random.uniform() - 0.5), side * (random.uniform() - 0.5), up * h / 2},
                         {0, 0, up}};
  });
}

}  // namespace
}  // namespace astrolith
