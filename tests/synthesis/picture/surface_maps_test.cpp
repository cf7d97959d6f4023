#include "synthesis/picture/surface_maps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

// A map of heights f(x, y) in length units at pixel centres.
template <class Heights>
std::vector<float> map_of(int width, int height, const Heights& f) {
  std::vector<float> values;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) values.push_back(static_cast<float>(f(x, y)));
  }
  return values;
}

// A slope that rises by 0.5 to the right and by 0.25 up the picture has one normal, borders included.
TEST(SurfaceMaps, NormalsOfAPlaneAreThatOfItsSlopes) {
  const double pixel = 0.01;
  const std::vector<float> heights =
      map_of(40, 30, [=](int x, int y) { return pixel * (0.5 * x - 0.25 * y); });
  const std::vector<float> normals = normal_map({heights, 40, 30, pixel, false});
  const double length = std::sqrt(1.0 + 0.25 + 0.0625);
  for (std::size_t i = 0; i < normals.size(); i += 3) {
    ASSERT_NEAR(static_cast<double>(normals[i]), -0.5 / length, 1e-4);
    ASSERT_NEAR(static_cast<double>(normals[i + 1]), -0.25 / length, 1e-4);
    ASSERT_NEAR(static_cast<double>(normals[i + 2]), 1.0 / length, 1e-4);
  }
}

// A map that repeats has the slopes of its copies at its border.
TEST(SurfaceMaps, ARepeatingMapIsMovedWithoutAChange) {
  const auto wave = [](int x, int y) {
    return 3.0 * std::sin(2.0 * std::numbers::pi * x / 32.0) +
           2.0 * std::cos(2.0 * std::numbers::pi * y / 32.0);
  };
  const std::vector<float> a = map_of(32, 32, wave),
                           b = map_of(32, 32, [&](int x, int y) { return wave((x + 16) % 32, y); });
  const std::vector<float> na = normal_map({a, 32, 32, 1.0, true}), nb = normal_map({b, 32, 32, 1.0, true}),
                           oa = occlusion_map({a, 32, 32, 1.0, true}),
                           ob = occlusion_map({b, 32, 32, 1.0, true});
  for (std::size_t y = 0; y < 32; ++y) {
    for (std::size_t x = 0; x < 32; ++x) {
      const std::size_t i = 32 * y + x, j = 32 * y + (x + 16) % 32;
      ASSERT_EQ(oa[j], ob[i]);
      for (std::size_t k = 0; k < 3; ++k) ASSERT_EQ(na[3 * j + k], nb[3 * i + k]);
    }
  }
}

TEST(SurfaceMaps, OpenGroundIsNotOccluded) {
  const std::vector<float> flat(50 * 50, 7.0f);
  for (const bool repeats : {false, true}) {
    for (const float open : occlusion_map({flat, 50, 50, 1.0, repeats})) ASSERT_EQ(open, 1.0f);
  }
}

// At the bottom of a long V-shaped groove of slope t, the horizon at azimuth a has the tangent t |cos a|.
TEST(SurfaceMaps, AGrooveHidesAsMuchSkyAsItsHorizonSays) {
  const double t = 0.8, pixel = 0.1;
  const std::vector<float> heights =
      map_of(257, 257, [=](int x, int) { return t * pixel * std::abs(x - 128); });
  const std::vector<float> open = occlusion_map({heights, 257, 257, pixel, false});
  double expected = 0.0;
  for (int k = 0; k < kOcclusionAzimuths; ++k) {
    const double horizon = t * std::cos(2.0 * std::numbers::pi * k / kOcclusionAzimuths);
    expected += 1.0 / (1.0 + horizon * horizon) / kOcclusionAzimuths;
  }
  EXPECT_NEAR(static_cast<double>(open[128 * 257 + 128]), expected, 0.03);
  EXPECT_GT(open[128 * 257 + 60], open[128 * 257 + 128]);
}

TEST(SurfaceMaps, HaveTheSameBytesForOneThreadAndForMany) {
  const std::vector<float> heights = map_of(150, 90, [](int x, int y) { return (x * 37 + y * 91) % 29; });
  const auto maps = [&](int threads) {
    const ThreadLimit limit(threads);
    std::vector<float> both = normal_map({heights, 150, 90, 2.0, true});
    const std::vector<float> open = occlusion_map({heights, 150, 90, 2.0, true});
    both.insert(both.end(), open.begin(), open.end());
    return both;
  };
  EXPECT_EQ(maps(1), maps(2));
}

TEST(SurfaceMaps, TakeMapsOfOnePixel) {
  const std::vector<float> one{3.0f};
  EXPECT_EQ(normal_map({one, 1, 1, 1.0, false}), (std::vector<float>{0.0f, 0.0f, 1.0f}));
  EXPECT_EQ(occlusion_map({one, 1, 1, 1.0, false}), std::vector<float>{1.0f});
  EXPECT_EQ(occlusion_map({one, 1, 1, 1.0, true}), std::vector<float>{1.0f});
}

}  // namespace
}  // namespace astrolith
