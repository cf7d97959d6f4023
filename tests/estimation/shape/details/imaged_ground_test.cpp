#include "estimation/shape/details/imaged_ground.h"

#include <gtest/gtest.h>

#include <cmath>

#include "numerics/hash_random.h"

namespace astrolith {
namespace {

// Places on a unit sphere, whose roughness within 6 edges is `smooth` where x is above `from`.
SurfaceStatistics sphere_smooth_beyond(double from, double smooth) {
  SurfaceStatistics statistics;
  statistics.edge = 0.05;
  LocalStatistic roughness{SurfaceQuantity::roughness, 6.0, {}};
  CounterRandom random(7);
  for (int i = 0; i < 600; ++i) {
    const double z = random.uniform(-1.0, 1.0), angle = random.uniform(0.0, 6.283185307179586);
    const double r = std::sqrt(1.0 - z * z);
    statistics.places.push_back({r * std::cos(angle), r * std::sin(angle), z});
    const double middle = statistics.places.back().x > from ? smooth : -4.0;
    roughness.values.push_back(middle + 0.5 * random.normal());
  }
  statistics.local.push_back(std::move(roughness));
  return statistics;
}

TEST(ImagedGround, TheSideWithoutDetailsIsFound) {
  EXPECT_NEAR(unseen_share(sphere_smooth_beyond(0.1, -8.0)), 0.45, 0.08);
}

TEST(ImagedGround, ABodyThatIsRoughEverywhereHasNone) {
  EXPECT_EQ(unseen_share(sphere_smooth_beyond(2.0, -8.0)), 0.0);
}

// A smoother region of a real body, such as a sea of regolith, is no ground without details.
TEST(ImagedGround, ARegionOfAThirdOfTheRoughnessIsNone) {
  EXPECT_EQ(unseen_share(sphere_smooth_beyond(0.1, -5.1)), 0.0);
}

}  // namespace
}  // namespace astrolith
