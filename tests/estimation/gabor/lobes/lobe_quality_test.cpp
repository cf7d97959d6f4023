#include "estimation/gabor/lobes/lobe_quality.h"

#include <gtest/gtest.h>

#include <cmath>

#include "estimation/gabor/gabor_fit.h"
#include "estimation/gabor/spectrum/spectrum_estimate.h"
#include "tests/estimation/gabor/known_spectrum.h"

namespace astrolith {
namespace {

PowerSpectrum scaled(PowerSpectrum spectrum, double variance) {
  const double gain = variance / spectrum.variance();
  for (double& p : spectrum.power) p *= gain;
  return spectrum;
}

// Square roots of Gamma variates: sqrt(pi)/2, 3 sqrt(pi/2)/4 and 1 - 1/(8 m).
TEST(LobeQuality, KnowsTheScatterOfPeriodograms) {
  EXPECT_NEAR(mean_root_of_scatter(1.0), 0.886226925, 1e-8);
  EXPECT_NEAR(mean_root_of_scatter(0.5), 0.75 * std::sqrt(3.14159265358979 / 2.0), 1e-8);
  EXPECT_NEAR(mean_root_of_scatter(1e-3), 1.0 - 1.25e-4, 1e-7);
}

// The true spectrum itself is the perfect model. Its distance from a periodogram is that of speckle alone,
// and it is never called weak.
TEST(LobeQuality, ThePerfectModelIsNeverWeak) {
  int weak = 0, count = 0;
  double perfect = 0.0;
  for (const testing::NamedSpectrum& truth : testing::known_spectra()) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed, ++count) {
      const PowerSpectrum periodogram = power_spectrum(testing::realisation_of(truth.spectrum, seed));
      const LobeQuality q = judge_lobes(scaled(truth.spectrum, periodogram.variance()), periodogram, 0.0);
      weak += q.weak();
      perfect += q.periodogram_distance;
      EXPECT_LT(q.weak_above, 0.45) << truth.name;
    }
  }
  EXPECT_EQ(weak, 0);
  EXPECT_NEAR(perfect / count, 0.477, 0.01);
}

// Segments that overlap scatter as their taper says: the perfect model of white noise scores no residual.
TEST(LobeQuality, TheScatterOfOverlappingSegmentsIsRight) {
  CounterRandom random(5);
  GreyImage image{300, 200, {}};
  for (int i = 0; i < 300 * 200; ++i) image.values.push_back(random.normal());
  const PowerSpectrum periodogram = exemplar_periodogram(image, 64);
  PowerSpectrum truth{64, 64, std::vector<double>(64 * 64, 1.0)};
  truth.power[0] = 0.0;
  const LobeQuality q = judge_lobes(scaled(truth, periodogram.variance()), periodogram, 0.0);
  EXPECT_LT(periodogram.scatter, 0.2);
  EXPECT_NEAR(q.periodogram_distance, q.perfect_distance, 0.05 * q.perfect_distance);
  EXPECT_FALSE(q.weak());
}

// A spectrum that is wrong by a known distance.
TEST(LobeQuality, MeasuresTheDistanceBehindTheSpeckle) {
  const PowerSpectrum truth = testing::ring_spectrum(), other = testing::broad_spectrum();
  double true_square = 0.0, norm = 0.0;
  for (std::size_t i = 1; i < truth.power.size(); ++i) {
    true_square += std::pow(std::sqrt(other.power[i]) - std::sqrt(truth.power[i]), 2);
    norm += truth.power[i];
  }
  const double distance = std::sqrt(true_square / norm);
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const PowerSpectrum periodogram = power_spectrum(testing::realisation_of(truth, seed));
    const LobeQuality q = judge_lobes(scaled(other, periodogram.variance()), periodogram, 0.0);
    EXPECT_NEAR(q.residual, distance, 0.05);
    EXPECT_TRUE(q.weak());
    EXPECT_LT(q.band_overlap, 0.8);
  }
}

// Whole fits: they are not weak, and are weak when they may have too few lobes. Distances from the raw
// periodogram were called poor only above 0.6.
TEST(LobeQuality, FewLobesMakeAWeakFit) {
  int weak = 0, weak_with_few = 0, count = 0, above_the_old_limit = 0;
  for (const testing::NamedSpectrum& truth : testing::known_spectra()) {
    const GreyImage exemplar = testing::realisation_of(truth.spectrum, 1);
    weak += fit_gabor_lobes(exemplar, "exemplar", {}).quality.weak();
    GaborFitOptions few;
    few.max_lobes = 1;
    const GaborFit fit = fit_gabor_lobes(exemplar, "exemplar", few);
    weak_with_few += fit.quality.weak();
    above_the_old_limit += fit.spectrum_distance > 0.6;
    ++count;
  }
  EXPECT_EQ(weak, 0);
  EXPECT_EQ(weak_with_few, count);
  EXPECT_LT(above_the_old_limit, count);
}

// The shares of the octaves add up to the whole variance.
TEST(LobeQuality, OctavesHoldTheWholeVariance) {
  const PowerSpectrum periodogram = power_spectrum(testing::realisation_of(testing::steep_spectrum(), 1));
  const LobeQuality q = judge_lobes(periodogram, periodogram, 0.0);
  double photo = 0.0;
  for (const BandVariance& band : q.bands) {
    photo += band.photo;
    EXPECT_DOUBLE_EQ(band.photo, band.noise);
    EXPECT_DOUBLE_EQ(band.highest, 2.0 * band.lowest);
  }
  EXPECT_NEAR(photo, 1.0, 1e-9);
  EXPECT_NEAR(q.band_overlap, 1.0, 1e-9);
}

}  // namespace
}  // namespace astrolith
