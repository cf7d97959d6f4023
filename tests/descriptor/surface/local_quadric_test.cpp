#include "descriptor/surface/local_quadric.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "numerics/hash_random.h"

namespace astrolith {
namespace {

std::vector<Vec3d> points_of(const LocalQuadric& quadric, int n, double noise, std::uint64_t seed) {
  CounterRandom random(seed, 0);
  std::vector<Vec3d> points;
  for (int i = 0; i < n; ++i) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
    points.push_back({x, y, quadric.height(x, y) + noise * random.normal()});
  }
  return points;
}

const LocalQuadric kQuadric{{0.3, -0.2, 0.1, 0.5, -0.7, 0.25}};

TEST(LocalQuadric, FindsAParaboloidExactly) {
  const auto fitted = fit_quadric(points_of(kQuadric, 40, 0, 1));
  ASSERT_TRUE(fitted);
  for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(fitted->c[k], kQuadric.c[k], 1e-13);
}

TEST(LocalQuadric, NormalStandsOnTheSurface) {
  const double h = 1e-6;
  const Vec3d n = kQuadric.normal(0.4, -0.3);
  const double z = kQuadric.height(0.4, -0.3);
  EXPECT_NEAR(dot(n, Vec3d{h, 0, kQuadric.height(0.4 + h, -0.3) - z}), 0, 1e-11);
  EXPECT_NEAR(dot(n, Vec3d{0, h, kQuadric.height(0.4, -0.3 + h) - z}), 0, 1e-11);
  EXPECT_NEAR(norm(n), 1, 1e-15);
}

TEST(LocalQuadric, HasNoneWherePointsDoNotDetermineIt) {
  std::vector<Vec3d> line;
  for (int i = 0; i < 30; ++i) line.push_back({0.05 * i, 0.1 * i, 0.0});
  EXPECT_FALSE(fit_quadric(line));
  EXPECT_FALSE(fit_quadric(points_of(kQuadric, 5, 0, 2)));
}

TEST(ResidualMoments, RmsOfKnownNoiseIsUnbiased) {
  double mean_square = 0;
  const int trials = 400, n = 20;
  for (int t = 0; t < trials; ++t) {
    const auto points = points_of(kQuadric, n, 0.1, static_cast<std::uint64_t>(10 + t));
    const auto fitted = fit_quadric(points);
    ASSERT_TRUE(fitted);
    std::vector<double> residuals;
    for (const Vec3d& p : points) residuals.push_back(p.z - fitted->height(p.x, p.y));
    const double rms = residual_moments(residuals, 1e-9).rms;
    mean_square += rms * rms / trials;
  }
  EXPECT_NEAR(mean_square, 0.01, 4 * 0.01 * std::sqrt(2.0 / (14 * trials)));
}

TEST(ResidualMoments, FollowTheirDefinition) {
  // Two values: skewness (1 - 2p) / sqrt(p (1 - p)), kurtosis 1 / (p (1 - p)) - 6, for a share p of the
  // upper.
  std::vector<double> values(100, -0.1);
  for (std::size_t i = 0; i < 10; ++i) values[i] = 0.9;
  const ResidualMoments m = residual_moments(values, 1e-9);
  EXPECT_NEAR(m.skewness, 0.8 / 0.3, 1e-12);
  EXPECT_NEAR(m.kurtosis, 1 / 0.09 - 6, 1e-12);
  EXPECT_NEAR(m.rms, std::sqrt(9.0 / 94), 1e-14);
  for (double& v : values) v = -v;
  EXPECT_NEAR(residual_moments(values, 1e-9).skewness, -0.8 / 0.3, 1e-12);
  EXPECT_EQ(residual_moments(values, 10).skewness, 0);
}

}  // namespace
}  // namespace astrolith
