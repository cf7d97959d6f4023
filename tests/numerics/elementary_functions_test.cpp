#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "numerics/branch_free.h"
#include "numerics/hash_random.h"
#include "numerics/host_device.h"
#include "numerics/portable_angles.h"
#include "numerics/portable_double.h"
#include "numerics/scalar_math.h"

namespace astrolith {
namespace {

TEST(ScalarMath, ExpIsWithinTwoUlp) {
  for (float x = -86.9f; x < 88.0f; x += 0.00731f) {
    const double exact = std::exp(static_cast<double>(x));
    ASSERT_NEAR(math::exp(x) / exact, 1.0, 2 * 5.97e-8) << x;
  }
}

TEST(ScalarMath, ExpAtItsEnds) {
  EXPECT_EQ(math::exp(0.0f), 1.0f);
  EXPECT_EQ(math::exp(-87.5f), 0.0f);
  EXPECT_EQ(math::exp(-1e30f), 0.0f);
  EXPECT_TRUE(std::isfinite(math::exp(1e30f)));
}

TEST(ScalarMath, ExpWithinItsRangeHasTheBitsOfExp) {
  for (float x = -87.0f; x <= 88.0f; x += 0.000917f) {
    ASSERT_EQ(math::to_bits(math::exp_within_range(x)), math::to_bits(math::exp(x))) << x;
  }
}

TEST(ScalarMath, LogIsWithinTwoUlp) {
  EXPECT_EQ(math::log(1.0f), 0.0f);
  for (double x = 2e-38; x < 3e38; x *= 1.0037) {
    const float f = static_cast<float>(x);
    const double exact = std::log(static_cast<double>(f));
    ASSERT_NEAR(math::log(f), exact, 2 * 5.97e-8 * std::max(std::fabs(exact), 1e-6)) << x;
  }
}

TEST(ScalarMath, LogNearOneKeepsItsBits) {
  for (float f = 0.9f; f < 1.1f; f += 1.3e-5f) {
    const double exact = std::log(static_cast<double>(f));
    ASSERT_NEAR(math::log(f), exact, 2 * 5.97e-8 * std::fabs(exact) + 1e-12) << f;
  }
}

TEST(ScalarMath, LogOfZeroIsFinite) { EXPECT_NEAR(math::log(0.0f), -87.33, 0.01); }

TEST(ScalarMath, SineAndCosineInTurns) {
  for (float x = -40.0f; x < 40.0f; x += 0.000713f) {
    const double angle = 2 * 3.14159265358979323846 * static_cast<double>(x);
    ASSERT_NEAR(math::sin_turns(x), std::sin(angle), 3e-7) << x;
    ASSERT_NEAR(math::cos_turns(x), std::cos(angle), 7e-7) << x;
  }
}

TEST(ScalarMath, AnglesInTurns) {
  for (float turn = -0.4999f; turn < 0.5f; turn += 0.000137f) {
    for (const float length : {1e-18f, 0.3f, 1e15f}) {
      const float y = length * math::sin_turns(turn), x = length * math::cos_turns(turn);
      const double exact = std::atan2(double{y}, double{x}) / (2 * 3.14159265358979323846);
      ASSERT_NEAR(math::atan2_turns(y, x), exact, 6e-8) << turn;
    }
  }
  EXPECT_EQ(math::atan2_turns(0.0f, 0.0f), 0.0f);
  EXPECT_EQ(math::atan2_turns(3e38f, 0.0f), 0.25f);
}

TEST(ScalarMath, RoundAndFloor) {
  EXPECT_EQ(math::round_even(2.5f), 2.0f);
  EXPECT_EQ(math::round_even(-3.5f), -4.0f);
  EXPECT_EQ(math::floor(-0.25f), -1.0f);
  EXPECT_EQ(math::floor(3.0f), 3.0f);
  EXPECT_EQ(math::floor(2.999f), 2.0f);
}

// The promise behind "same bits": a loop gives what single calls give, whichever vector width the machine
// uses.
ASTROLITH_SIMD_CLONES void evaluate_all(const float* x, float* y, int n) {
#pragma omp simd
  for (int i = 0; i < n; ++i) y[i] = math::exp(x[i]) + math::log(math::abs(x[i])) * math::cos_turns(x[i]);
}

TEST(ScalarMath, VectorisedLoopGivesTheBitsOfOneCall) {
  std::vector<float> x(4099), y(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = -70.0f + 0.0311f * static_cast<float>(i);
  evaluate_all(x.data(), y.data(), static_cast<int>(x.size()));
  for (std::size_t i = 0; i < x.size(); ++i) {
    volatile float one = x[i];
    float single;
    const float xi = one;
    evaluate_all(&xi, &single, 1);
    ASSERT_EQ(math::to_bits(single), math::to_bits(y[i])) << x[i];
  }
}

// Units in the last place of the truth.
double ulps(double value, long double truth) {
  const double size = std::fabs(static_cast<double>(truth));
  return static_cast<double>(std::fabs(value - truth)) /
         (std::nextafter(size, std::numeric_limits<double>::infinity()) - size);
}

double random_unit(int i, int which) { return unit_float(hash_cell(7u, i, which, 0)); }

TEST(BranchFree, AnglesAreWithinTwoUlp) {
  double worst = 0.0;
  for (int i = 0; i < 200000; ++i) {
    const double x = (2 * random_unit(i, 0) - 1) * std::exp2(40 * random_unit(i, 2) - 20);
    const double y = (2 * random_unit(i, 1) - 1) * std::exp2(40 * random_unit(i, 3) - 20);
    if (x == 0.0 || y == 0.0) continue;
    worst = std::max(worst, ulps(branch_free::atan2(y, x), atan2l(y, x)));
  }
  EXPECT_LE(worst, 2.0);
  EXPECT_EQ(branch_free::atan2(0, 0), 0.0);
  EXPECT_EQ(branch_free::atan2(0, 1), 0.0);
  EXPECT_DOUBLE_EQ(branch_free::atan2(0, -1), std::numbers::pi);
}

// Small differences take the series, large ones the quotient.
TEST(BranchFree, LogarithmsOfRatiosAreWithinTwoUlp) {
  double worst = 0.0;
  for (int i = 0; i < 200000; ++i) {
    const double sum = 1.0 + random_unit(i, 0), difference = sum * std::exp2(-40 * random_unit(i, 1)) * 0.999;
    const double above = sum + difference, below = sum - difference;
    // The arguments are exact only as far as their sums are.
    if (above - sum != difference || sum - below != difference) continue;
    const double quotient = above / below;
    const long double truth =
        quotient > std::sqrt(2.0) ? logl(quotient) : 2 * atanhl(static_cast<long double>(difference) / sum);
    worst = std::max(worst, ulps(branch_free::log_ratio(above, below, difference, sum), truth));
  }
  EXPECT_LE(worst, 2.0);
  EXPECT_TRUE(std::isfinite(branch_free::log_ratio(1.0, 0.0, 1.0, 1.0)));
  EXPECT_TRUE(std::isfinite(branch_free::log_ratio(0.0, 0.0, 0.0, 0.0)));
}

TEST(BranchFree, LogarithmsOfLargeRatios) {
  for (const double q : {1.5, 10.0, 1e5, 1e100, 1e289}) {
    const double sum = q + 1.0, difference = q - 1.0;
    EXPECT_LE(ulps(branch_free::log_ratio(q, 1.0, difference, sum), logl(q)), 2.0) << q;
  }
  EXPECT_EQ(branch_free::log_ratio(1.0, 1.0, 0.0, 2.0), 0.0);
}

TEST(BranchFree, AnglesInAllQuadrantsAndOnTheAxes) {
  for (const double y : {-3.0, -1e-200, 0.0, 1e-200, 1.0, 1e200}) {
    for (const double x : {-2.0, -1e-200, 0.0, 1e-200, 1.0, 1e200}) {
      EXPECT_NEAR(branch_free::atan2(y, x), portable::atan2(y, x), 1e-15) << y << " " << x;
      EXPECT_EQ(branch_free::atan2(-y, x), y == 0.0 ? branch_free::atan2(y, x) : -branch_free::atan2(y, x));
    }
  }
}

constexpr int kLanes = 64;
using Lanes = std::array<double, kLanes>;

ASTROLITH_SIMD_CLONES void loop_over_both(const double* __restrict x, const double* __restrict y,
                                          double* __restrict angles, double* __restrict logarithms) {
#pragma omp simd
  for (int i = 0; i < kLanes; ++i) {
    angles[i] = branch_free::atan2(y[i], x[i]);
    logarithms[i] = branch_free::log_ratio(2.0 + x[i], 2.0 - x[i], x[i], 2.0);
  }
}

// A vectorised loop gives the bits of single calls.
TEST(BranchFree, SameBitsInALoop) {
  Lanes x{}, y{}, angles{}, logarithms{};
  for (int i = 0; i < kLanes; ++i) {
    x[static_cast<std::size_t>(i)] = 2.0 * random_unit(i, 5);
    y[static_cast<std::size_t>(i)] = 2.0 * random_unit(i, 6) - 1.0;
  }
  loop_over_both(x.data(), y.data(), angles.data(), logarithms.data());
  for (std::size_t i = 0; i < kLanes; ++i) {
    EXPECT_EQ(angles[i], branch_free::atan2(y[i], x[i]));
    EXPECT_EQ(logarithms[i], branch_free::log_ratio(2.0 + x[i], 2.0 - x[i], x[i], 2.0));
  }
}

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

// The error in units of 1e-16 against the truth, which has 64 bits.
double relative_error(double value, long double truth) {
  return static_cast<double>(std::fabs(static_cast<long double>(value) - truth) * 1e16L);
}

TEST(PortableAngles, SineAndCosineHaveTheStatedAccuracy) {
  CounterRandom random(1);
  double worst = 0.0, worst_tangent = 0.0;
  for (int i = 0; i < 400'000; ++i) {
    const double reach = i % 4 == 0 ? 1e5 : i % 4 == 1 ? 100.0 : i % 4 == 2 ? 7.0 : 1.0;
    const double angle = random.uniform(-reach, reach);
    const long double exact = static_cast<long double>(angle);
    worst = std::max({worst, relative_error(portable::sin(angle), sinl(exact)),
                      relative_error(portable::cos(angle), cosl(exact))});
    const double steep = random.uniform(-1.56, 1.56);
    const long double truth = tanl(static_cast<long double>(steep));
    worst_tangent =
        std::max(worst_tangent, relative_error(static_cast<double>(portable::tan(steep) / truth), 1.0L));
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
    worst = std::max(worst, relative_error(portable::atan2(y, x), atan2l(y, x)));
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
