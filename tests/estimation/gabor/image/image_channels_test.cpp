#include <cmath>

#include "estimation/gabor/image/image_channels.h"
#include "estimation/gabor/spectrum/power_spectrum.h"
#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "tests/estimation/gabor/known_spectrum.h"

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

// A texture of mean 0.5 and standard deviation 0.1.
GreyImage texture() {
  GreyImage image = testing::draw_realisation(testing::four_lobe_spectrum(), 3);
  for (double& v : image.values) v = 0.5 + 0.1 * v;
  return image;
}

template <typename Change>
GreyImage changed(GreyImage image, const Change& change) {
  std::size_t i = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x, ++i) {
      image.values[i] =
          change(image.values[i], 2.0 * x / (image.width - 1) - 1.0, 2.0 * y / (image.height - 1) - 1.0);
    }
  }
  return image;
}

double distance(const GreyImage& a, const GreyImage& b) {
  return optimal_transport_distance(exemplar_periodogram(a), exemplar_periodogram(b));
}

double largest_difference(const GreyImage& a, const GreyImage& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.values.size(); ++i)
    largest = std::max(largest, std::abs(a.values[i] - b.values[i]));
  return largest;
}

TEST(Detrend, APolynomialLeavesNothing) {
  const GreyImage flat{70, 41, std::vector<double>(70 * 41, 0.0)};
  for (int degree = 1; degree <= kLargestTrendDegree; ++degree) {
    GreyImage image = changed(flat, [&](double, double x, double y) {
      return 3.0 + std::pow(x, degree) - 2.0 * std::pow(y, degree) + std::pow(x, degree - 1) * y;
    });
    double mean = 0.0;
    for (const double v : image.values) mean += v / (70 * 41);
    remove_trend(image, degree, TrendModel::kAdded, "p");
    for (const double v : image.values) ASSERT_NEAR(v, mean, 1e-11) << degree;
  }
}

// The image without its trend holds no trend, so a second removal changes nothing.
TEST(Detrend, IsAProjection) {
  GreyImage once = texture();
  remove_trend(once, 3, TrendModel::kAdded, "p");
  GreyImage twice = once;
  remove_trend(twice, 3, TrendModel::kAdded, "p");
  EXPECT_LT(largest_difference(once, twice), 1e-12);
}

// The trend is a light spot, since the periodic component alone would already remove a slope.
TEST(Detrend, ASpotOnATextureGoesAndTheTextureStays) {
  const GreyImage clean = texture();
  GreyImage image =
      changed(clean, [](double v, double x, double y) { return v + 0.4 * x - 0.5 * (x * x + y * y); });
  EXPECT_GT(distance(image, clean), 0.25);
  remove_trend(image, 2, TrendModel::kAdded, "p");
  EXPECT_LT(distance(image, clean), 0.05);
}

// Uneven light scales the contrast too. Division restores the contrast, subtraction cannot.
TEST(Detrend, UnevenLightGoesByDivision) {
  const GreyImage clean = texture();
  const GreyImage lit = changed(clean, [](double v, double x, double) { return v * (1.0 + 0.6 * x); });
  GreyImage divided = lit, subtracted = lit;
  remove_trend(divided, 1, TrendModel::kMultiplied, "p");
  remove_trend(subtracted, 1, TrendModel::kAdded, "p");
  EXPECT_LT(distance(divided, clean), 0.1);
  EXPECT_GT(distance(subtracted, clean), 2 * distance(divided, clean));
}

TEST(Detrend, DivisionByATrendNearZeroIsRefused) {
  GreyImage image = changed(texture(), [](double v, double x, double) { return v + x; });
  EXPECT_THROW(remove_trend(image, 1, TrendModel::kMultiplied, "p"), InputError);
}

}  // namespace
}  // namespace astrolith
