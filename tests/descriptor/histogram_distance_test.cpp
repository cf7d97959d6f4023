#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "descriptor/histogram_distance.h"
#include "descriptor/shape_distribution.h"
#include "descriptor/surflet_histogram.h"
#include "geometry/surface/mesh_sampling.h"
#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"
#include "tests/descriptor/surflets.h"
#include "tests/support/meshes.h"

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
double marginal_distance(std::span<const double> f, std::span<const double> g) {
  return marginal_earth_movers_distance(f, g, 3);
}

TEST(HistogramDistance, Metrics) {
  CounterRandom random(1);
  for (int k = 0; k < 300; ++k) {
    const Histogram f = random_histogram(random, 81), g = random_histogram(random, 81),
                    h = random_histogram(random, 81);
    for (const Distance d : {&l2_distance, &root_chi_square, &jensen_shannon_distance, &earth_movers_distance,
                             &circular_earth_movers_distance, &marginal_distance}) {
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

// Chords of a sphere have the density l / (2 R^2) on (0, 2 R) and the mean 4 R / 3. With x = l / mean, the
// share of chords up to x is 4 x^2 / 9.
TEST(ShapeDistribution, OfASphereIsTheClosedForm) {
  const SurfaceSamples s = sample_poisson_disk(testing::icosphere(5, 2.0), 4000, 1);
  const ShapeDistribution d = shape_distribution(s.points, 30);
  EXPECT_NEAR(d.mean_distance, 8.0 / 3, 0.005);
  const std::vector<double> f = d.frequencies();
  for (int b = 0; b < 30; ++b) {
    const auto up_to = [](double x) { return std::min(1.0, 4 * x * x / 9); };
    EXPECT_NEAR(f[static_cast<std::size_t>(b)], up_to(0.1 * (b + 1)) - up_to(0.1 * b), 0.002) << b;
  }
}

// Two points of a rod of length 1 are farther apart than l with probability (1 - l)^2; the mean is 1 / 3.
TEST(ShapeDistribution, OfARodIsTheClosedForm) {
  std::vector<Vec3d> rod;
  for (int i = 0; i < 3000; ++i) rod.push_back({1.0, (i + 0.5) / 3000, -2.0});
  const std::vector<double> f = shape_distribution(rod, 10).frequencies();
  for (int b = 0; b < 10; ++b) {
    EXPECT_NEAR(f[static_cast<std::size_t>(b)],
                (1 - 0.1 * b) * (1 - 0.1 * b) - (0.9 - 0.1 * b) * (0.9 - 0.1 * b), 0.001);
  }
}

TEST(ShapeDistribution, CountsEachPairOnceForAnyThreadCount) {
  const SurfaceSamples s = sample_surface(testing::torus(1, 0.4), 700, 3);
  const ShapeDistribution all = shape_distribution(s.points, 64);
  EXPECT_EQ(all.pairs, 700u * 699 / 2);
  EXPECT_EQ(std::accumulate(all.counts.begin(), all.counts.end(), std::uint64_t{0}), all.pairs);
  const ThreadLimit one(1);
  const ShapeDistribution single = shape_distribution(s.points, 64);
  EXPECT_EQ(single.counts, all.counts);
  EXPECT_EQ(single.mean_distance, all.mean_distance);
}

TEST(ShapeDistribution, KnowsNoPlaceDirectionOrScale) {
  SurfaceSamples s = sample_surface(testing::torus(1, 0.4), 500, 3);
  const ShapeDistribution before = shape_distribution(s.points, 64);
  for (Vec3d& p : s.points) p = Vec3d{10, -3, 2} + 7.0 * Vec3d{p.y, p.z, p.x};
  const ShapeDistribution after = shape_distribution(s.points, 64);
  EXPECT_NEAR(after.mean_distance, 7 * before.mean_distance, 1e-12);
  std::uint64_t moved = 0;  // pairs that rounding moved over a border
  for (std::size_t b = 0; b < 64; ++b) {
    moved += std::max(after.counts[b], before.counts[b]) - std::min(after.counts[b], before.counts[b]);
  }
  EXPECT_LE(moved, 4u);
}

TEST(ShapeDistribution, RefusesWhatHasNoDistances) {
  EXPECT_THROW(shape_distribution({}, 10), InputError);
  const std::vector<Vec3d> one_place(5, Vec3d{1, 2, 3});
  EXPECT_THROW(shape_distribution(one_place, 10), InputError);
  const std::vector<Vec3d> two{{0, 0, 0}, {1, 0, 0}};
  EXPECT_THROW(shape_distribution(two, 0), InputError);
  EXPECT_THROW(shape_distribution(two, 1 << 20), InputError);
  const std::vector<Vec3d> endless{{0, 0, 0}, {std::numeric_limits<double>::infinity(), 0, 0}};
  EXPECT_THROW(shape_distribution(endless, 10), InputError);
  EXPECT_EQ(shape_distribution(two, 9).counts[3], 1u);  // the only distance is the mean
}

using namespace testing;

double by_force(const std::vector<Vec3d>& points) {
  double largest = 0;
  for (const Vec3d& p : points) {
    for (const Vec3d& q : points) largest = std::max(largest, norm(p - q));
  }
  return largest;
}

TEST(LargestDistance, EqualsBruteForce) {
  for (int n : {2, 3, 63, 64, 65, 66, 129, 1000}) {
    const auto cube_points = random_surflets(n, 7).points;
    EXPECT_NEAR(largest_distance(cube_points), by_force(cube_points), 1e-14) << n;
    auto ball = random_surflets(n, 8).normals;  // on the unit sphere, where no pair can be left out
    EXPECT_NEAR(largest_distance(ball), by_force(ball), 1e-14) << n;
    for (Vec3d& p : ball) p.x *= 5;
    EXPECT_NEAR(largest_distance(ball), by_force(ball), 1e-14) << n;
  }
}

// The outermost points all lie on one side, and the largest distance is not between two of them.
TEST(LargestDistance, IsNotFooledByAClusterFarOut) {
  std::vector<Vec3d> points = {{-1, 0, 0}};
  for (int i = 0; i < 200; ++i) points.push_back({1.01 + 1e-4 * i, 0.001 * i, 0});
  EXPECT_NEAR(largest_distance(points), by_force(points), 1e-14);
}

TEST(LargestDistance, FewPoints) {
  EXPECT_EQ(largest_distance({}), 0);
  EXPECT_EQ(largest_distance(std::vector<Vec3d>{{1, 2, 3}}), 0);
  EXPECT_EQ(largest_distance(std::vector<Vec3d>(5, Vec3d{1, 2, 3})), 0);
}

}  // namespace
}  // namespace astrolith
