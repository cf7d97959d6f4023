#include "numerics/portable_double.h"

#include "numerics/hash_random.h"

namespace astrolith {
namespace {

TEST(PortableDouble, HasTheStandardLibrarysValues) {
  CounterRandom random(1);
  for (int i = 0; i < 200000; ++i) {
    const double x = random.uniform(-708.0, 709.0), small = random.uniform(-1.0, 1.0);
    ASSERT_NEAR(portable::exp(x) / std::exp(x), 1.0, 2e-15) << x;
    ASSERT_NEAR(portable::exp(small), std::exp(small), 2e-15) << small;
    const double y = std::exp(x);
    ASSERT_NEAR(portable::log(y), std::log(y), 2e-15 * std::fabs(std::log(y)) + 2e-15) << y;
    const double near_one = 1.0 + 0.5 * small;
    ASSERT_NEAR(portable::log(near_one), std::log(near_one), 2e-15) << near_one;
    ASSERT_NEAR(portable::pow(near_one, 9.0 * small) / std::pow(near_one, 9.0 * small), 1.0, 2e-14);
  }
}

TEST(PortableDouble, EndsAsItSays) {
  EXPECT_EQ(portable::exp(0.0), 1.0);
  EXPECT_EQ(portable::exp(-709.0), 0.0);
  EXPECT_EQ(portable::exp(1e300), portable::exp(709.0));
  EXPECT_EQ(portable::log(1.0), 0.0);
  EXPECT_NEAR(portable::log(0.0), -708.4, 0.1);
  EXPECT_EQ(portable::pow(0.0, 0.0), 1.0);
  EXPECT_EQ(portable::pow(0.0, 2.5), 0.0);
}

}  // namespace
}  // namespace astrolith
