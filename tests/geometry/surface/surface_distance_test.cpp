#include "geometry/surface/surface_distance.h"

#include "numerics/errors.h"
#include "tests/support/meshes.h"

namespace astrolith {
namespace {

using namespace testing;

TEST(SurfaceDistance, ConcentricSpheres) {
  const auto r = surface_distance(icosphere(5, 1), icosphere(5, 1.1), 4000, 1);
  EXPECT_NEAR(r.mean, 0.1, 1e-3);
  EXPECT_NEAR(r.p99, 0.1, 1e-3);
  EXPECT_NEAR(r.max, 0.1, 1e-3);
}

// The small body a is part of b, so that every point of a lies on b. The other sphere of b is far from a.
TEST(SurfaceDistance, LooksInBothDirections) {
  const TriangleMesh a = icosphere(4), b = joined(a, icosphere(4, 1, {5, 0, 0}));
  const auto r = surface_distance(a, b, 4000, 1);
  EXPECT_LT(r.from_a_to_b.max, 1e-9);
  EXPECT_NEAR(r.from_b_to_a.max, 5, 0.1);
  EXPECT_NEAR(r.mean, (r.from_a_to_b.mean + r.from_b_to_a.mean) / 2, 1e-12);
  EXPECT_EQ(r.max, r.from_b_to_a.max);
}

// A strip of height 1 stands upright on a floor: its distances to the floor are uniform in [0, 1].
TEST(SurfaceDistance, FiguresOfAKnownDistribution) {
  const TriangleMesh strip{{{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}}, {{0, 1, 2}, {0, 2, 3}}, {}};
  const TriangleMesh floor{{{-1, -1, 0}, {2, -1, 0}, {2, 1, 0}, {-1, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}, {}};
  const auto r = surface_distance(strip, floor, 40000, 7).from_a_to_b;
  EXPECT_NEAR(r.mean, 0.5, 5 * 0.29 / 200);
  EXPECT_NEAR(r.p99, 0.99, 5 * 0.1 / 200);
  EXPECT_NEAR(r.max, 1, 1e-3);
  EXPECT_LE(r.max, 1);
}

// One of a hundred distances is larger.
TEST(SurfaceDistance, ThePercentileIsANearestRank) {
  const auto r = surface_distance(icosphere(2), torus(1, 0.3), 100, 2).from_a_to_b;
  EXPECT_LT(r.p99, r.max);
}

TEST(SurfaceDistance, ScalesWithTheUnit) {
  const auto small = surface_distance(icosphere(3, 1e-3), torus(1e-3, 3e-4), 500, 2);
  const auto large = surface_distance(icosphere(3, 1e5), torus(1e5, 3e4), 500, 2);
  EXPECT_NEAR(large.mean / small.mean, 1e8, 1);
}

TEST(SurfaceDistance, NeedsASample) { EXPECT_THROW(surface_distance(cube(), cube(), 0, 1), InputError); }

}  // namespace
}  // namespace astrolith
