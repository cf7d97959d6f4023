#include "descriptor/largest_distance.h"

#include "tests/descriptor/surflets.h"

namespace astrolith {
namespace {

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
