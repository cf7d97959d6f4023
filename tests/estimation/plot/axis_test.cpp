#include "estimation/plot/axis.h"

#include <gtest/gtest.h>

#include <cmath>

namespace astrolith {
namespace {

std::string tick_texts(const Axis& axis) {
  std::string all;
  for (const auto& tick : axis.ticks) all += tick.second + " ";
  return all;
}

TEST(LinearAxis, HasTicksAtRoundNumbers) {
  EXPECT_EQ(tick_texts(linear_axis(0.0, 616.0, "")), "0 200 400 600 ");
  EXPECT_EQ(tick_texts(linear_axis(-0.207, 0.207, "")), "-0.2 -0.1 0 0.1 0.2 ");
}

TEST(LinearAxis, KeepsTicksApartBySmallestStep) {
  EXPECT_EQ(tick_texts(linear_axis(0.0, 2.0, "", 1.0)), "0 1 2 ");
}

TEST(LogarithmicAxis, HasTicksAtOneTwoAndFive) {
  const Axis axis = logarithmic_axis(0.048, 1.1, "");
  EXPECT_EQ(tick_texts(axis), "0.02 0.05 0.1 0.2 0.5 1 2 ");
  EXPECT_NEAR(axis.low, std::log10(0.02), 1e-12);
  EXPECT_NEAR(axis.high, std::log10(2.0), 1e-12);
}

TEST(LogarithmicAxis, HasAnExtentWhereBothEndsAreEqual) {
  EXPECT_EQ(tick_texts(logarithmic_axis(10.0, 10.0, "")), "10 20 ");
  EXPECT_EQ(tick_texts(logarithmic_axis(0.001, 0.001, "")), "0.001 0.002 ");
}

}  // namespace
}  // namespace astrolith
