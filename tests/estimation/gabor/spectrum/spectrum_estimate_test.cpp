#include "estimation/gabor/spectrum/spectrum_estimate.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "estimation/gabor/spectrum/spectrum_distance.h"
#include "tests/estimation/gabor/known_spectrum.h"

namespace astrolith {
namespace {

// On every kind of spectrum the estimate is nearer to the truth than the best Gaussian smoothing of one
// width, which is chosen with knowledge of the truth.
TEST(SpectrumEstimate, IsNearerToTheTruthThanTheBestSmoothing) {
  const std::map<std::string, double> best_smoothed = {{"four lobes", 0.136}, {"ring", 0.113},
                                                       {"steep", 0.154},      {"lines", 0.200},
                                                       {"broad", 0.070},      {"eight Gabor lobes", 0.175}};
  for (const testing::NamedSpectrum& known : testing::known_spectra()) {
    double distance = 0.0;
    double predicted = 0.0;
    constexpr int kSeeds = 4;
    for (int seed = 1; seed <= kSeeds; ++seed) {
      const PowerSpectrum periodogram =
          power_spectrum(testing::realisation_of(known.spectrum, static_cast<std::uint64_t>(seed)));
      const SpectrumEstimate estimate = estimate_spectrum(periodogram);
      EXPECT_NEAR(estimate.spectrum.variance(), periodogram.variance(), 1e-9);
      distance += optimal_transport_distance(estimate.spectrum, known.spectrum) / kSeeds;
      predicted += estimate.standard_error / kSeeds;
    }
    EXPECT_LT(distance, 0.95 * best_smoothed.at(known.name)) << known.name;
    EXPECT_NEAR(predicted / distance, 1.0, 0.35) << known.name;
  }
}

// So it is where most power lies below three cycles an image.
TEST(SpectrumEstimate, OfASmoothHeightMapIsNearerThanTheBestSmoothing) {
  double distance = 0.0;
  constexpr int kSeeds = 8;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const PowerSpectrum periodogram =
        power_spectrum(testing::realisation_of(testing::smooth_spectrum(), seed));
    distance +=
        optimal_transport_distance(estimate_spectrum(periodogram).spectrum, testing::smooth_spectrum()) /
        kSeeds;
  }
  EXPECT_LT(distance, 0.95 * 0.288);
}

TEST(SpectrumEstimate, TurnsWithTheImage) {
  const GreyImage image = testing::realisation_of(testing::four_lobe_spectrum(), 8);
  GreyImage turned = image;
  for (int y = 0; y < 128; ++y) {
    for (int x = 0; x < 128; ++x) turned.values[static_cast<std::size_t>(x * 128 + y)] = image.at(x, y);
  }
  const PowerSpectrum a = estimate_spectrum(power_spectrum(image)).spectrum;
  const PowerSpectrum b = estimate_spectrum(power_spectrum(turned)).spectrum;
  double largest = 0.0;
  for (int y = 0; y < 128; ++y) {
    for (int x = 0; x < 128; ++x) {
      largest = std::max(largest, std::abs(a.power[static_cast<std::size_t>(y * 128 + x)] -
                                           b.power[static_cast<std::size_t>(x * 128 + y)]));
    }
  }
  EXPECT_LT(largest, 1e-4 * *std::max_element(a.power.begin(), a.power.end()));
}

// White noise has no features that smoothing could blur. An oblique peak has.
TEST(SpectrumEstimate, SmoothsWhiteNoiseMoreThanAPeak) {
  PowerSpectrum flat{128, 128, std::vector<double>(128 * 128, 1.0)};
  flat.power[0] = 0.0;
  const SpectrumEstimate white = estimate_spectrum(power_spectrum(testing::realisation_of(flat, 3)));
  const PowerSpectrum peaked = testing::four_lobe_spectrum();
  const SpectrumEstimate peaks = estimate_spectrum(power_spectrum(testing::realisation_of(peaked, 3)));
  EXPECT_GE(white.smoothing[5].width_bins, 5.0);
  EXPECT_LE(peaks.smoothing[3].width_bins, 2.5);  // 8 to 16 bins: where the strongest lobe sits
}

TEST(SpectrumEstimate, IsSymmetricPositiveAndZeroAtFrequencyZero) {
  PowerSpectrum lines{35, 48, std::vector<double>(35 * 48, 0.0)};  // a cosine: nearly all bins empty
  lines.power[3] = lines.power[32] = 10.0;
  const SpectrumEstimate estimate = estimate_spectrum(lines);
  EXPECT_EQ(estimate.spectrum.power[0], 0.0);
  EXPECT_GT(*std::min_element(estimate.spectrum.power.begin() + 1, estimate.spectrum.power.end()), 0.0);
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 35; ++x) {
      const double here = estimate.spectrum.power[static_cast<std::size_t>(y * 35 + x)];
      EXPECT_NEAR(here, estimate.spectrum.power[static_cast<std::size_t>((48 - y) % 48 * 35 + (35 - x) % 35)],
                  1e-9 * (1.0 + here));
    }
  }
}

}  // namespace
}  // namespace astrolith
