#include "numerics/scalar_math.h"

#include <vector>

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
    ASSERT_EQ(math::bits_of(math::exp_within_range(x)), math::bits_of(math::exp(x))) << x;
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
    ASSERT_EQ(math::bits_of(single), math::bits_of(y[i])) << x[i];
  }
}

}  // namespace
}  // namespace astrolith
