#include "descriptor/local_features.h"

#include "tests/descriptor/surflets.h"

namespace astrolith {
namespace {

using namespace testing;

TEST(LocalFeatures, NormalPerturbation) {
  const Vec3d center{1, 2, 3};
  for (const double angle : {0.0, 1e-9, 0.3, std::numbers::pi / 2, 3.0, std::numbers::pi}) {
    const Vec3d normal{std::sin(angle), 0, std::cos(angle)};
    EXPECT_NEAR(normal_perturbation(center + Vec3d{0, 0, 7}, normal, center), angle, 1e-15);
  }
  EXPECT_DOUBLE_EQ(normal_perturbation(center, {0, 0, 1}, center), std::numbers::pi / 2);
}

TEST(LocalFeatures, CurvatureIsBoundedAndOdd) {
  EXPECT_EQ(bounded_curvature(0), 0);
  EXPECT_EQ(bounded_curvature(1), 0.5);
  for (const double x : {0.1, 2.0, 1e6, 1e300}) {
    EXPECT_LE(bounded_curvature(x), 1);
    EXPECT_EQ(bounded_curvature(-x), -bounded_curvature(x));
  }
}

TEST(LocalFeatures, SpreadOfASphere) {
  std::vector<Vec3d> points = {{2, 0, 0}, {-2, 0, 0}, {0, 2, 0}, {0, -2, 0}};
  for (Vec3d& p : points) p += Vec3d{5, 6, 7};
  const PointSpread spread = point_spread(points);
  EXPECT_EQ(spread.center, (Vec3d{5, 6, 7}));
  EXPECT_EQ(spread.mean_square, 4);
  EXPECT_EQ(point_spread({}).mean_square, 0);
}

TEST(LocalFeatures, CodesAreEtaThenKappa) {
  const std::vector<Vec3d> points = {{0, 0, 1}, {0, 0, -1}};
  const std::vector<Vec3d> normals = {{0, 0, 1}, {0, 0, 1}};  // eta = 0 and pi
  const std::vector<double> curvatures = {1, -1e9};
  EXPECT_EQ(local_codes(points, normals, curvatures, 5), (std::vector<std::int32_t>{0 * 5 + 3, 4 * 5 + 0}));
  EXPECT_EQ(local_codes(points, normals, curvatures, 10), (std::vector<std::int32_t>{7, 90}));
}

}  // namespace
}  // namespace astrolith
