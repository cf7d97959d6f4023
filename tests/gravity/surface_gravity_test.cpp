#include "gravity/surface_gravity.h"

#include <gtest/gtest.h>

#include <numbers>

namespace astrolith {
namespace {

using std::numbers::pi;

// A ball of 1 km and 2,000 kg/m3: the attraction at its surface for G times density = 1, in km.
const Attraction kAtSurface{4 * pi / 3, {-4 * pi / 3, 0, 0}};

TEST(SurfaceGravity, UnitsAndRotation) {
  Rotation rotation;
  rotation.rate = 1e-4;
  const std::vector<Vec3d> points{{1000, 0, 500}};
  const PointGravity g = point_gravity(points, std::vector<Attraction>{kAtSurface}, 2000, 1000, rotation)[0];
  const double gm = kGravitationalConstant * 2000 * 4 * pi / 3;
  EXPECT_NEAR(g.potential, -gm * 1e6, 1e-12);
  EXPECT_NEAR(g.acceleration.x, -gm * 1e3, 1e-15);
  EXPECT_NEAR(g.geopotential, -gm * 1e6 - 0.5 * 1e-8 * 1e6, 1e-12);
  EXPECT_NEAR(g.effective.x, -gm * 1e3 + 1e-8 * 1000, 1e-15);
  EXPECT_EQ(g.effective.z, 0.0);
}

TEST(SurfaceGravity, TurnsAboutAnAxisThroughItsCentre) {
  const Rotation rotation{{10, 20, 30}, normalized(Vec3d{1, 1, 0}), 2e-3};
  const std::vector<Vec3d> points{Vec3d{10, 20, 30} + 5.0 * Vec3d{1, 1, 0} + Vec3d{0, 0, 7}};
  const PointGravity g = point_gravity(points, std::vector<Attraction>(1), 1, 1, rotation)[0];
  EXPECT_NEAR(g.geopotential, -0.5 * 4e-6 * 49, 1e-18);
  EXPECT_NEAR(norm(g.effective - Vec3d{0, 0, 7 * 4e-6}), 0, 1e-18);
}

TEST(SurfaceGravity, Slopes) {
  EXPECT_NEAR(slope_degrees({0, 0, 1}, {0, 0, -2e-3}), 0.0, 1e-12);
  EXPECT_NEAR(slope_degrees({0, 0, 1}, {0, -1e-3, -1e-3}), 45.0, 1e-12);
  EXPECT_NEAR(slope_degrees({0, 0, 1}, {0, 0, 1e-3}), 180.0, 1e-12);
  EXPECT_EQ(slope_degrees({0, 0, 1}, {0, 0, 0}), 90.0);
}

TEST(SurfaceGravity, ElevationsAreAboutTheirMean) {
  std::vector<PointGravity> values(2);
  values[0].geopotential = -50, values[1].geopotential = -56;
  values[0].effective = {0, 0, -4e-3}, values[1].effective = {0, 0, -7e-3};
  const std::vector<double> areas{1.0, 2.0};
  const SurfaceMeans means = surface_means(values, areas);
  EXPECT_DOUBLE_EQ(means.geopotential, -54.0);
  EXPECT_DOUBLE_EQ(means.effective, 6e-3);
  EXPECT_NEAR(elevation(values[0], means), 4.0 / 6e-3, 1e-9);
  EXPECT_NEAR(elevation(values[1], means), -2.0 / 6e-3, 1e-9);
}

}  // namespace
}  // namespace astrolith
