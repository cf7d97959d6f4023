#include <cmath>

#include "estimation/plot/figure.h"
#include "numerics/errors.h"
#include "tests/support/scratch_folder.h"

namespace astrolith {
namespace {

// Bytes 16 to 23 of a PNG hold its width and its height, big-endian.
int png_number(const std::string& png, std::size_t at) {
  int value = 0;
  for (std::size_t i = at; i < at + 4; ++i) value = value << 8 | static_cast<unsigned char>(png.at(i));
  return value;
}

TEST(Figure, WritesPngOfThePageSize) {
  const testing::ScratchFolder folder;
  Figure page(144.0, 72.0);
  page.fill({0.0, 0.0, 10.0, 10.0}, {1.0, 0.0, 0.0});
  page.write_png(folder / "page.png", 100.0);
  const std::string png = testing::read_text(folder / "page.png");
  EXPECT_EQ(png_number(png, 16), 200);
  EXPECT_EQ(png_number(png, 20), 100);
}

TEST(Figure, DrawsTextThatIsNotUtf8) {
  const testing::ScratchFolder folder;
  Figure page(100.0, 50.0);
  page.text(5.0, 20.0, "gr\xfcn.png", 10.0);
  EXPECT_NO_THROW(page.write_svg(folder / "page.svg"));
  EXPECT_NE(testing::read_text(folder / "page.svg").find("</svg>"), std::string::npos);
}

TEST(Figure, RefusesFilesThatCannotBeWritten) {
  const testing::ScratchFolder folder;
  EXPECT_THROW(Figure(10.0, 10.0).write_png(folder / "missing" / "page.png", 72.0), InputError);
}

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
