#include "estimation/gabor/spectrum/power_spectrum.h"

#include <cmath>
#include <numbers>

#include "numerics/errors.h"
#include "numerics/hash_random.h"

namespace astrolith {
namespace {

GreyImage white_noise(int width, int height, std::uint64_t seed) {
  CounterRandom random(seed);
  GreyImage image{width, height, {}};
  for (int i = 0; i < width * height; ++i) image.values.push_back(0.5 + 0.1 * random.normal());
  return image;
}

double sample_variance(const GreyImage& image) {
  double mean = 0.0;
  for (const double v : image.values) mean += v;
  mean /= static_cast<double>(image.values.size());
  double sum = 0.0;
  for (const double v : image.values) sum += (v - mean) * (v - mean);
  return sum / static_cast<double>(image.values.size());
}

TEST(PowerSpectrum, MeanPowerIsTheVariance) {
  for (const auto& [w, h] : {std::pair{32, 32}, {33, 48}, {47, 35}}) {
    const GreyImage image = white_noise(w, h, 3);
    EXPECT_NEAR(power_spectrum(image).variance(), sample_variance(image), 1e-14);
  }
}

// A photo of 12,000 x 5,000 pixels has 200 tiles, which take seconds.
TEST(PowerSpectrum, AMeanOverTilesIsReportedAndStops) {
  const GreyImage image = white_noise(160, 96, 3);
  int reports = 0;
  exemplar_periodogram(image, 32, [&](double, std::string_view) { return ++reports > 0; });
  EXPECT_EQ(reports, 9 * 5);
  EXPECT_THROW(exemplar_periodogram(image, 32, [](double, std::string_view) { return false; }), WorkError);
}

TEST(PowerSpectrum, IsSymmetric) {
  const PowerSpectrum s = power_spectrum(white_noise(33, 48, 4));
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 33; ++x) {
      EXPECT_DOUBLE_EQ(s.power[static_cast<std::size_t>(y * 33 + x)],
                       s.power[static_cast<std::size_t>((48 - y) % 48 * 33 + (33 - x) % 33)]);
    }
  }
}

// A cosine of amplitude a has the variance a^2/2, all of it in two bins.
TEST(PowerSpectrum, OfACosineIsTwoBins) {
  GreyImage image{64, 48, {}};
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) {
      image.values.push_back(0.5 + 0.2 * std::cos(2.0 * std::numbers::pi * (5.0 * x / 64 - 7.0 * y / 48)));
    }
  }
  const PowerSpectrum s = power_spectrum(image);
  const double each = 0.5 * 0.5 * 0.2 * 0.2 * 64 * 48;
  EXPECT_NEAR(s.power[41 * 64 + 5], each, 1e-10);
  EXPECT_NEAR(s.power[7 * 64 + 59], each, 1e-10);
  EXPECT_NEAR(s.variance(), 0.02, 1e-13);
}

TEST(PowerSpectrum, LargeExemplarsAreAveragedOverTiles) {
  const GreyImage image = white_noise(150, 100, 5);
  const PowerSpectrum s = exemplar_periodogram(image, 64);
  EXPECT_EQ(s.width, 64);
  EXPECT_EQ(s.height, 64);
  EXPECT_NEAR(s.variance(), sample_variance(image), 0.05 * sample_variance(image));
  // The speckle of a single periodogram is as large as the spectrum. Averaging must have lowered it.
  double square = 0.0;
  for (const double p : s.power) square += (p / s.variance() - 1.0) * (p / s.variance() - 1.0);
  EXPECT_LT(square / static_cast<double>(s.power.size()), 1.5 / s.averages);
  EXPECT_GT(s.averages, 3.0);
}

}  // namespace
}  // namespace astrolith
