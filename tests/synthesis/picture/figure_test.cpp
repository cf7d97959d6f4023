#include <cmath>

#include "numerics/errors.h"
#include "synthesis/picture/figure.h"
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

TEST(Figure, LiesOverAPictureOfSixteenBits) {
  RgbaImage16 image{4, 600, std::vector<std::uint16_t>(4 * 4 * 600, 12345)};
  Figure page(4.0, 600.0, Figure::Paper::kNone);
  page.fill({1.0, 2.0, 2.0, 596.0}, {1.0, 0.0, 0.0});
  page.draw_over(image);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const std::uint16_t* pixel = &image.pixels[static_cast<std::size_t>(4 * (4 * y + x))];
      const bool inside = x >= 1 && x < 3 && y >= 2 && y < 598;
      ASSERT_EQ(pixel[0], inside ? 65535 : 12345) << x << " " << y;
      ASSERT_EQ(pixel[3], inside ? 65535 : 12345) << x << " " << y;
    }
  }
}

TEST(Figure, WritesPagesOfVectorsThatStayTheSame) {
  const testing::ScratchFolder folder;
  Figure page(100.0, 50.0);
  page.picture({0.0, 0.0, 50.0, 50.0}, RgbaImage16{2, 1, {0, 0, 0, 65535, 65535, 0, 0, 32768}});
  page.text(5.0, 20.0, "slope [\u00b0]", 10.0);
  for (const std::string name : {"first", "second"}) {
    page.write_pdf(folder / (name + ".pdf"));
    page.write_svg(folder / (name + ".svg"), 2.0);
  }
  const std::string pdf = testing::read_text(folder / "first.pdf"),
                    svg = testing::read_text(folder / "first.svg");
  EXPECT_EQ(pdf.substr(0, 5), "%PDF-");
  EXPECT_EQ(pdf, testing::read_text(folder / "second.pdf"));
  EXPECT_NE(svg.find("width=\"50pt\""), std::string::npos);
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
