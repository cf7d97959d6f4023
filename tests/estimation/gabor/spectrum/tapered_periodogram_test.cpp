#include "estimation/gabor/spectrum/tapered_periodogram.h"

#include <cmath>
#include <string>
#include <vector>

#include "estimation/gabor/spectrum/spectrum_distance.h"
#include "estimation/gabor/spectrum/spectrum_estimate.h"
#include "numerics/sample_statistics.h"
#include "tests/estimation/gabor/known_spectrum.h"

namespace astrolith {
namespace {

// The mean power of an octave, from `lowest` to twice as many cycles a side.
double power_of_octave(const PowerSpectrum& s, double lowest) {
  double sum = 0.0;
  int bins = 0;
  for (int y = 0; y < s.height; ++y) {
    for (int x = 0; x < s.width; ++x) {
      const double r = std::hypot(signed_frequency(x, s.width), signed_frequency(y, s.height));
      if (r < lowest || r >= 2.0 * lowest) continue;
      sum += s.power[static_cast<std::size_t>(y * s.width + x)];
      ++bins;
    }
  }
  return sum / bins;
}

PowerSpectrum spectrum_of_square(const GreyImage& image) {
  return least_leaky(tapered_power(image, image.width, image.height));
}

// Spectra with most power below three cycles an image, and white noise, on squares cut out of larger
// textures.
TEST(TaperedPeriodogram, DoesNotLeak) {
  const auto falling = [](double exponent) {
    return [exponent](double fx, double fy) { return std::pow(0.1 + fx * fx + fy * fy, -0.5 * exponent); };
  };
  for (const double exponent : {0.0, 2.0, 3.0, 4.0, 5.0}) {
    const auto truth = falling(exponent);
    std::vector<double> ratio(4);
    constexpr int kSeeds = 12;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      const testing::CutTexture cut = testing::unscaled_cut(truth, seed);
      const PowerSpectrum spectrum = spectrum_of_square(cut.image);
      for (std::size_t k = 0; k < ratio.size(); ++k) {
        const double lowest = std::ldexp(4.0, static_cast<int>(k));
        ratio[k] += power_of_octave(spectrum, lowest) / power_of_octave(cut.truth, lowest) / kSeeds;
      }
    }
    for (const double r : ratio) EXPECT_NEAR(std::log(r), 0.0, 0.3) << "f^-" << exponent;
  }
}

// A texture has the variance of its pixels. A ramp of ten times as much is left out, and does not enter the
// texture's octaves.
TEST(TaperedPeriodogram, LeavesARampOut) {
  GreyImage image = testing::unscaled_cut(testing::ring_power, 3).image;
  const PowerSpectrum bare = spectrum_of_square(image);
  const double variance = variance_of(image.values);
  EXPECT_NEAR(bare.variance(), variance, 0.05 * variance);
  const double slope = std::sqrt(10.0 * variance * 12.0) / 128.0;
  for (std::size_t i = 0; i < image.values.size(); ++i)
    image.values[i] += slope * static_cast<double>(i % 128);
  const PowerSpectrum spectrum = spectrum_of_square(image);
  EXPECT_NEAR(spectrum.variance(), variance, 0.2 * variance);
  EXPECT_NEAR(power_of_octave(spectrum, 16.0) / power_of_octave(bare, 16.0), 1.0, 0.1);
}

// A grid of finer frequencies shows the same spectrum.
TEST(TaperedPeriodogram, OnAFinerGridIsTheSame) {
  const GreyImage cut =
      testing::unscaled_cut([](double fx, double fy) { return 1.0 / (1.0 + fx * fx + fy * fy); }, 4).image;
  const PowerSpectrum coarse = spectrum_of_square(cut), fine = least_leaky(tapered_power(cut, 256, 256));
  EXPECT_NEAR(fine.variance() / coarse.variance(), 1.0, 0.1);
  for (const double lowest : {4.0, 8.0, 16.0, 32.0}) {
    EXPECT_NEAR(power_of_octave(fine, 2.0 * lowest) / power_of_octave(coarse, lowest), 1.0, 0.1) << lowest;
  }
}

}  // namespace
}  // namespace astrolith
