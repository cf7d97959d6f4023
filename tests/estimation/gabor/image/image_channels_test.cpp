#include "estimation/gabor/image/image_channels.h"

#include <cmath>

#include "numerics/hash_random.h"

namespace astrolith {
namespace {

// Colours that vary along known axes with known deviations.
std::vector<GreyImage> colors(double first, double second) {
  CounterRandom random(11);
  std::vector<GreyImage> planes(3, GreyImage{64, 64, {}});
  for (int i = 0; i < 64 * 64; ++i) {
    const double a = first * random.normal(), b = second * random.normal();
    planes[0].values.push_back(0.5 + 0.6 * a - 0.8 * b);
    planes[1].values.push_back(0.4 + 0.8 * a + 0.6 * b);
    planes[2].values.push_back(0.3);
  }
  return planes;
}

double dot(const Vec3d& a, const Vec3d& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

TEST(ImageChannels, AreThePrincipalComponents) {
  const std::vector<ImageChannel> channels = principal_channels(colors(0.1, 0.02));
  ASSERT_EQ(channels.size(), 2u);  // nothing varies along blue
  EXPECT_NEAR(channels[0].axis.x, 0.6, 0.02);
  EXPECT_NEAR(channels[0].axis.y, 0.8, 0.02);
  EXPECT_NEAR(dot(channels[0].axis, channels[1].axis), 0.0, 1e-12);
  double product = 0.0, first_mean = 0.0, second_mean = 0.0;
  for (std::size_t i = 0; i < 64 * 64; ++i) {
    first_mean += channels[0].image.values[i] / 4096;
    second_mean += channels[1].image.values[i] / 4096;
    product += channels[0].image.values[i] * channels[1].image.values[i] / 4096;
  }
  EXPECT_NEAR(product - first_mean * second_mean, 0.0, 1e-12);
}

// Synthesis relies on rgb = mean + sum of axis * (image - its mean).
TEST(ImageChannels, AddUpToTheColours) {
  const std::vector<GreyImage> planes = colors(0.1, 0.02);
  const Vec3d mean = mean_color(planes);
  const std::vector<ImageChannel> channels = principal_channels(planes);
  for (std::size_t i = 0; i < 64 * 64; i += 97) {
    double red = mean.x, green = mean.y, blue = mean.z;
    for (const ImageChannel& c : channels) {
      const double d = c.image.values[i] - dot(c.axis, mean);
      red += c.axis.x * d;
      green += c.axis.y * d;
      blue += c.axis.z * d;
    }
    EXPECT_NEAR(red, planes[0].values[i], 1e-12);
    EXPECT_NEAR(green, planes[1].values[i], 1e-12);
    EXPECT_NEAR(blue, planes[2].values[i], 1e-12);
  }
}

TEST(ImageChannels, OfAGreyImageIsOneAndBright) {
  std::vector<GreyImage> planes = colors(0.1, 0.0);
  planes[1] = planes[2] = planes[0];
  const std::vector<ImageChannel> channels = principal_channels(planes);
  ASSERT_EQ(channels.size(), 1u);
  for (const double part : {channels[0].axis.x, channels[0].axis.y, channels[0].axis.z})
    EXPECT_NEAR(part, 1 / std::sqrt(3.0), 1e-9);
}

TEST(ImageChannels, ConstantImagesStillHaveOne) {
  std::vector<GreyImage> planes(3, GreyImage{8, 8, std::vector<double>(64, 0.5)});
  EXPECT_EQ(principal_channels(planes).size(), 1u);
}

}  // namespace
}  // namespace astrolith
