#include "descriptor/shape_distribution.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "geometry/surface/mesh_sampling.h"
#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "tests/support/meshes.h"

namespace astrolith {
namespace {

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

}  // namespace
}  // namespace astrolith
