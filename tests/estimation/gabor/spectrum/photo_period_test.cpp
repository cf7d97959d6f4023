#include "estimation/gabor/spectrum/photo_period.h"

#include <cmath>

#include "estimation/gabor/spectrum/border_taper.h"
#include "numerics/errors.h"
#include "numerics/hash_random.h"

namespace astrolith {
namespace {

double random_value(int x, int y, int seed) {
  return static_cast<double>(unit_float(hash_cell(static_cast<std::uint32_t>(seed), x, y, 0)));
}

template <typename Value>
GreyImage make_image(int width, int height, const Value& value) {
  GreyImage image{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) image.values.push_back(value(x, y));
  }
  return image;
}

// Smooth noise whose period is px x py pixels, with errors of random size up to `error`.
GreyImage tiled(int width, int height, int px, int py, double error = 0.0) {
  return make_image(width, height, [&](int x, int y) {
    double sum = 0.0;
    for (int k = 0; k < 9; ++k) sum += random_value((x + k % 3) % px, (y + k / 3) % py, 1) / 9.0;
    return sum + error * (random_value(x, y, 2) - 0.5);
  });
}

void expect_period(const GreyImage& image, int x, int y) {
  const PhotoPeriod period = find_period({image});
  EXPECT_EQ(period.x, x);
  EXPECT_EQ(period.y, y);
}

TEST(PhotoPeriod, OfTilesExactAndNearlySo) {
  expect_period(tiled(160, 120, 40, 30), 40, 30);
  expect_period(tiled(160, 120, 40, 30, 0.05), 40, 30);
  expect_period(tiled(150, 100, 40, 33), 40, 33);  // not a whole number of them
  expect_period(tiled(100, 70, 50, 1000), 50, 0);  // just two, along x only
  expect_period(tiled(640, 32, 32, 1000), 32, 0);  // a thin strip
  expect_period(tiled(64, 64, 7, 9), 7, 9);
  expect_period(make_image(64, 64, [](int x, int y) { return (x + y) % 2; }), 2, 2);
  expect_period(make_image(96, 64, [](int x, int) { return x / 4 % 2; }), 8, 0);
}

TEST(PhotoPeriod, IsNoneWhereNothingRepeats) {
  for (int seed = 1; seed <= 5; ++seed) {
    expect_period(make_image(96, 80, [&](int x, int y) { return random_value(x, y, seed); }), 0, 0);
    // Wide hills.
    expect_period(make_image(96, 80,
                             [&](int x, int y) {
                               double sum = 0.0;
                               for (int k = 0; k < 6; ++k) {
                                 sum += std::cos(0.1 * (random_value(k, 0, seed) - 0.5) * x +
                                                 0.1 * (random_value(k, 1, seed) - 0.5) * y + k);
                               }
                               return sum;
                             }),
                  0, 0);
  }
  expect_period(tiled(100, 100, 60, 70), 0, 0);  // less than two of them
  expect_period(make_image(64, 64, [](int x, int y) { return x + 2.0 * y; }), 0, 0);
  expect_period(make_image(64, 64, [](int, int) { return 0.5; }), 0, 0);
  expect_period(make_image(64, 64, [](int x, int y) { return x == 20 && y == 30 ? 1.0 : 0.0; }), 0, 0);
}

// Two ridges of nearly one form, as heights on uneven ground, are no tiles.
TEST(PhotoPeriod, IsNoneOfTwoAlikeRidges) {
  const auto ridge = [](double x, double width) { return std::exp(-0.5 * (x / width) * (x / width)); };
  for (const double noise : {0.0, 0.01, 0.03}) {
    expect_period(make_image(128, 96,
                             [&](int x, int y) {
                               return ridge(x - 35, 9) + 0.95 * ridge(x - 93, 10) +
                                      noise * random_value(x, y, 7);
                             }),
                  0, 0);
  }
}

TEST(PhotoPeriod, OneIsCutOutWhereItsBorderIsCalm) {
  // A bright pixel in the corner of each tile.
  const GreyImage comb =
      make_image(160, 120, [](int x, int y) { return x % 40 == 0 && y % 30 == 0 ? 1.0 : 0.0; });
  const PhotoPeriod period = find_period({comb});
  const std::vector<GreyImage> one = one_period({comb, comb}, period, 32);
  ASSERT_EQ(one.size(), 2u);
  EXPECT_EQ(one[0].width, 40);
  EXPECT_EQ(one[0].height, 60);  // 30 rows would be less than 32
  EXPECT_TRUE(repeats_along_x(one[0]));
  EXPECT_TRUE(repeats_along_y(one[0]));
  EXPECT_GT(*std::max_element(one[0].values.begin(), one[0].values.end()), 0.0);
}

TEST(PhotoPeriod, SearchStopsWhenAsked) {
  EXPECT_THROW(find_period({tiled(64, 64, 16, 16)}, [](double, std::string_view) { return false; }),
               WorkError);
}

}  // namespace
}  // namespace astrolith
