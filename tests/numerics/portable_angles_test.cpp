#include "numerics/portable_angles.h"

#include <gtest/gtest.h>

#include "numerics/hash_random.h"

namespace astrolith {
namespace {

// The error in units of 1e-16 against the truth, which has 64 bits.
double error_of(double value, long double truth) {
  return static_cast<double>(std::fabs(static_cast<long double>(value) - truth) * 1e16L);
}

TEST(PortableAngles, SineAndCosineHaveTheStatedAccuracy) {
  CounterRandom random(1);
  double worst = 0.0, worst_tangent = 0.0;
  for (int i = 0; i < 400'000; ++i) {
    const double reach = i % 4 == 0 ? 1e5 : i % 4 == 1 ? 100.0 : i % 4 == 2 ? 7.0 : 1.0;
    const double angle = random.uniform(-reach, reach);
    const long double exact = static_cast<long double>(angle);
    worst = std::max(
        {worst, error_of(portable::sin(angle), sinl(exact)), error_of(portable::cos(angle), cosl(exact))});
    const double steep = random.uniform(-1.56, 1.56);
    const long double truth = tanl(static_cast<long double>(steep));
    worst_tangent =
        std::max(worst_tangent, error_of(static_cast<double>(portable::tan(steep) / truth), 1.0L));
  }
  EXPECT_LT(worst, 4.0);
  EXPECT_LT(worst_tangent, 10.0);
  RecordProperty("worst_sine_1e_16", std::to_string(worst));
  RecordProperty("worst_tangent_1e_16", std::to_string(worst_tangent));
}

TEST(PortableAngles, ArcTangentHasTheStatedAccuracy) {
  CounterRandom random(2);
  double worst = 0.0;
  for (int i = 0; i < 400'000; ++i) {
    const double y = random.uniform(-1.0, 1.0), x = random.uniform(-1.0, 1.0) * (i % 3 == 0 ? 1e-9 : 1.0);
    worst = std::max(worst, error_of(portable::atan2(y, x), atan2l(y, x)));
  }
  EXPECT_LT(worst, 10.0);
  RecordProperty("worst_1e_16", std::to_string(worst));
}

TEST(PortableAngles, AxesAreExact) {
  EXPECT_EQ(portable::sin(0.0), 0.0);
  EXPECT_EQ(portable::cos(0.0), 1.0);
  EXPECT_EQ(portable::atan2(0.0, 0.0), 0.0);
  EXPECT_EQ(portable::atan2(0.0, 1.0), 0.0);
  EXPECT_EQ(portable::atan2(0.0, -1.0), std::numbers::pi);
  EXPECT_EQ(portable::atan2(1.0, 0.0), std::numbers::pi / 2);
  EXPECT_EQ(portable::atan2(-1.0, 0.0), -std::numbers::pi / 2);
  EXPECT_EQ(portable::atan2(1.0, 1.0), std::numbers::pi / 4);
}

// These bits hold on every machine; those of the C library do not.
TEST(PortableAngles, BitsAreThese) {
  EXPECT_EQ(portable::sin(1.0), 0x1.aed548f090ceep-1);
  EXPECT_EQ(portable::cos(100.0), 0x1.b981dbf665fep-1);
  EXPECT_EQ(portable::tan(1.5), 0x1.c33ed50b88778p+3);
  EXPECT_EQ(portable::atan2(3.0, -7.0), 0x1.5e4c36ca0118ap+1);
}

}  // namespace
}  // namespace astrolith
