#include "synthesis/relief/relief_laying.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace astrolith {
namespace {

// A patch of points, all laid before or none, with mismatches of a function of the place.
std::vector<SeamPoint> make_patch(bool laid, const std::function<double(double x, double y)>& mismatch) {
  std::vector<SeamPoint> points;
  for (int i = -30; i <= 30; ++i) {
    for (int k = -30; k <= 30; ++k) {
      const double x = i / 30.0, y = k / 30.0;
      if (x * x + y * y < 1.0) points.push_back({x, y, laid, mismatch(x, y)});
    }
  }
  return points;
}

TEST(ReliefSeam, RunsWhereBothHeightsAgree) {
  const auto off_the_circle = [](double x, double y) {
    return std::fabs(std::sqrt((x - 0.1) * (x - 0.1) + y * y) - 0.6);
  };
  const ReliefSeam seam(make_patch(true, off_the_circle));
  EXPECT_NEAR(seam.margin(0.7, 0.0), 0.0, 0.05);
  EXPECT_NEAR(seam.margin(-0.5, 0.0), 0.0, 0.05);
  EXPECT_NEAR(seam.margin(0.1, 0.6), 0.0, 0.05);
  EXPECT_GT(seam.margin(0.2, 0.1), 0.3);
}

TEST(ReliefSeam, GoesAroundALandform) {
  const auto crater = [](double x, double y) { return (x - 0.6) * (x - 0.6) + y * y < 0.04 ? 100.0 : 1.0; };
  const ReliefSeam seam(make_patch(true, crater));
  const double radius = seam.margin(0.6, 0.0) + 0.6;
  EXPECT_TRUE(radius < 0.45 || radius > 0.75);
}

TEST(ReliefSeam, IsWideWhereNothingHasBeenLaid) {
  const ReliefSeam seam(make_patch(false, [](double, double) { return 1.0; }));
  EXPECT_NEAR(seam.margin(0.5, 0.2), 0.917 - std::sqrt(0.29), 0.01);
}

TEST(ReliefSeam, IsSmoothedAlongItsLength) {
  const auto steep = [](double x, double y) {
    const double radius = x > 0.0 ? 0.8 : 0.4;
    return std::fabs(std::sqrt(x * x + y * y) - radius);
  };
  const ReliefSeam seam(make_patch(true, steep)), smooth = seam.smoothed(0.3);
  EXPECT_NEAR(seam.margin(0.0, 0.0), smooth.margin(0.0, 0.0), 0.5);
  EXPECT_LT(smooth.margin(0.1, 0.5), seam.margin(0.1, 0.5));
  EXPECT_NEAR(smooth.margin(0.5, 0.0), seam.margin(0.5, 0.0), 0.02);
}

}  // namespace
}  // namespace astrolith
