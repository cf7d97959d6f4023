#include "numerics/branch_free.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "numerics/hash_random.h"
#include "numerics/host_device.h"
#include "numerics/portable_angles.h"

namespace astrolith {
namespace {

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

ASTROLITH_SIMD_CLONES void loop_of_both(const double* __restrict x, const double* __restrict y,
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
  loop_of_both(x.data(), y.data(), angles.data(), logarithms.data());
  for (std::size_t i = 0; i < kLanes; ++i) {
    EXPECT_EQ(angles[i], branch_free::atan2(y[i], x[i]));
    EXPECT_EQ(logarithms[i], branch_free::log_ratio(2.0 + x[i], 2.0 - x[i], x[i], 2.0));
  }
}

}  // namespace
}  // namespace astrolith
