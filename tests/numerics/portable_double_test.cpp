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

TEST(PortableDouble, HasTheStatedAccuracy) {
  CounterRandom random(3);
  const auto relative = [](double value, long double truth) {
    return static_cast<double>(std::fabs(static_cast<long double>(value) / truth - 1.0L));
  };
  for (int i = 0; i < 300'000; ++i) {
    const double size = std::exp(random.uniform(-300.0, 300.0)), sign = i % 2 == 0 ? 1.0 : -1.0;
    const auto exact = static_cast<long double>(size);
    ASSERT_LT(relative(portable::cbrt(sign * size), static_cast<long double>(sign) * cbrtl(exact)), 4e-16)
        << size;
    ASSERT_LT(std::fabs(portable::log2(size) - std::log2(size)), 2e-15 * std::fabs(std::log2(size)) + 2e-15)
        << size;
    const double above =
        i % 3 == 0 ? random.uniform(-0.999, 5.0) : std::exp(random.uniform(-50.0, 0.0)) * sign;
    if (above <= -1.0 || above == 0.0) continue;
    ASSERT_LT(relative(portable::log1p(above), log1pl(static_cast<long double>(above))), 1e-15) << above;
    const double base = random.uniform(-3.0, 3.0);
    const int n = i % 24;
    ASSERT_LT(relative(portable::whole_power(base, n), powl(static_cast<long double>(base), n)),
              2.3e-16 * (n + 1));
  }
}

TEST(PortableDouble, SpecialValuesAreExact) {
  for (int e = -1000; e < 1000; ++e) ASSERT_EQ(portable::log2(std::ldexp(1.0, e)), e);
  EXPECT_EQ(portable::cbrt(0.0), 0.0);
  EXPECT_EQ(portable::cbrt(1.0), 1.0);
  EXPECT_EQ(portable::log1p(0.0), 0.0);
  EXPECT_EQ(portable::whole_power(2.0, 10), 1024.0);
  EXPECT_EQ(portable::whole_power(-3.0, 3), -27.0);
  EXPECT_EQ(portable::whole_power(0.0, 0), 1.0);
}

// These bits hold on every machine; those of the C library do not.
TEST(PortableDouble, BitsAreThese) {
  EXPECT_EQ(portable::exp(1.0), 0x1.5bf0a8b14576ap+1);
  EXPECT_EQ(portable::log(10.0), 0x1.26bb1bbb55516p+1);
  EXPECT_EQ(portable::log2(10.0), 0x1.a934f0979a371p+1);
  EXPECT_EQ(portable::pow(3.0, 0.7), 0x1.142e81c889914p+1);
  EXPECT_EQ(portable::cbrt(10.0), 0x1.13c484138704fp+1);
  EXPECT_EQ(portable::log1p(1e-3), 0x1.060354f8c3ebfp-10);
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
