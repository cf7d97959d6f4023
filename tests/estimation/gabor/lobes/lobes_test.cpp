#include <cmath>

#include "estimation/gabor/gabor_fit.h"
#include "estimation/gabor/lobes/lobe_quality.h"
#include "estimation/gabor/lobes/lobe_refinement.h"
#include "estimation/gabor/lobes/lobe_selection.h"
#include "estimation/gabor/spectrum/power_spectrum.h"
#include "estimation/gabor/spectrum/spectrum_estimate.h"
#include "numerics/parallel_for.h"
#include "tests/estimation/gabor/known_spectrum.h"

namespace astrolith {
namespace {

using testing::lobe_sum;

// Four lobes: the third is broad enough to wrap around the grid and lies on an axis, the fourth at frequency
// 0.
std::vector<SpectralLobe> four_lobes() {
  return {{4, 0.11, 0.06, 3.0}, {3, -0.2, 0.25, 1.0}, {1, 0.3, 0.0, 0.4}, {4, 0.0, 0.0, 0.7}};
}

std::vector<double> equal_weights(const PowerSpectrum& s) { return std::vector<double>(s.power.size(), 1.0); }

// A spectrum that is known with an error, every frequency of which counts alike.
SpectrumEstimate known(const PowerSpectrum& s) { return {s, {}, 0.09, equal_weights(s), 0.09}; }

std::vector<SpectralLobe> disturbed(std::vector<SpectralLobe> lobes) {
  double sign = 1.0;
  for (SpectralLobe& lobe : lobes) {
    lobe.x += sign * 0.4 * lobe_deviation(lobe.bandwidth);
    lobe.y += 0.3 * lobe_deviation(lobe.bandwidth);
    lobe.height *= 1.0 + 0.3 * sign;
    sign = -sign;
  }
  return lobes;
}

TEST(LobeMisfit, IsTheSquaredDistance) {
  const PowerSpectrum truth = lobe_sum(four_lobes(), 60, 48);
  const std::vector<SpectralLobe> lobes = disturbed(four_lobes());
  const LobeMisfit misfit(lobes, truth, equal_weights(truth));
  const std::vector<double> start(12, 0.0);
  EXPECT_NEAR(std::sqrt(misfit(start, {})), optimal_transport_distance(lobe_sum(lobes, 60, 48), truth), 1e-5);
}

TEST(LobeMisfit, GradientAgreesWithDifferences) {
  const PowerSpectrum truth = lobe_sum(four_lobes(), 60, 48);
  const LobeMisfit misfit(disturbed(four_lobes()), truth, octave_weights(truth));
  std::vector<double> p(12, 0.0);
  for (std::size_t i = 0; i < p.size(); ++i) p[i] = 0.1 * std::sin(3.0 * static_cast<double>(i));
  std::vector<double> gradient(12);
  misfit(p, gradient);
  for (std::size_t i = 0; i < p.size(); ++i) {
    constexpr double h = 1e-5;
    std::vector<double> q = p;
    q[i] = p[i] + h;
    const double above = misfit(q, {});
    q[i] = p[i] - h;
    EXPECT_NEAR(gradient[i], (above - misfit(q, {})) / (2.0 * h), 1e-6) << "parameter " << i;
  }
}

TEST(RefineLobes, FindsTheLobesOfAnExactSpectrum) {
  const PowerSpectrum truth = lobe_sum(four_lobes(), 64, 64);
  const std::vector<SpectralLobe> refined = refine_lobes(disturbed(four_lobes()), known(truth)).lobes;
  ASSERT_EQ(refined.size(), 4u);
  EXPECT_LT(optimal_transport_distance(lobe_sum(refined, 64, 64), truth), 0.01);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(refined[i].x, four_lobes()[i].x, 0.05 * lobe_deviation(refined[i].bandwidth));
    EXPECT_NEAR(refined[i].height, four_lobes()[i].height, 0.05 * four_lobes()[i].height);
  }
}

TEST(RefineLobes, ThreadsDoNotChangeABit) {
  const PowerSpectrum truth = lobe_sum(four_lobes(), 64, 48);
  const auto refined_with = [&](int threads) {
    const ThreadLimit limit(threads);
    return lobe_sum(refine_lobes(disturbed(four_lobes()), known(truth)).lobes, 64, 48).power;
  };
  EXPECT_EQ(refined_with(1), refined_with(4));
}

// Superfluous lobes are removed, and the lobes that carry the spectrum stay.
TEST(FewestLobes, KeepsWhatTheEstimateIsWorth) {
  const PowerSpectrum truth = lobe_sum(four_lobes(), 64, 64);
  std::vector<SpectralLobe> lobes = disturbed(four_lobes());
  for (const SpectralLobe& lobe : four_lobes()) {
    for (const double side : {-0.7, 0.7}) {
      SpectralLobe other = lobe;
      other.x += side * lobe_deviation(lobe.bandwidth);
      other.height *= 0.2;
      lobes.push_back(other);
    }
  }
  const std::vector<SpectralLobe> few = fewest_lobes(lobes, known(truth), equal_weights(truth)).lobes;
  EXPECT_LE(few.size(), 6u);
  EXPECT_GE(few.size(), 3u);
  EXPECT_LE(optimal_transport_distance(lobe_sum(few, 64, 64), truth), 0.03);
}

TEST(FewestLobes, KeepsTheLobesWhenAskedToStop) {
  const PowerSpectrum truth = lobe_sum(four_lobes(), 64, 64);
  int asked = 0;
  const auto stop = [&](double, std::string_view) { return ++asked < 4; };
  const RefinedLobes at_once = fewest_lobes(disturbed(four_lobes()), known(truth), equal_weights(truth),
                                            [](double, std::string_view) { return false; });
  const RefinedLobes soon = fewest_lobes(disturbed(four_lobes()), known(truth), equal_weights(truth), stop);
  EXPECT_FALSE(at_once.reached || soon.reached);
  EXPECT_EQ(at_once.lobes.size(), 4u);
  EXPECT_EQ(soon.lobes.size(), 4u);
  EXPECT_LT(optimal_transport_distance(lobe_sum(soon.lobes, 64, 64), truth),
            optimal_transport_distance(lobe_sum(at_once.lobes, 64, 64), truth));
  EXPECT_EQ(asked, 5);  // the loop asks once more after the minimisation has ended
}

PowerSpectrum scaled(PowerSpectrum spectrum, double variance) {
  const double gain = variance / spectrum.variance();
  for (double& p : spectrum.power) p *= gain;
  return spectrum;
}

// Square roots of Gamma variates: sqrt(pi)/2, 3 sqrt(pi/2)/4 and 1 - 1/(8 m).
TEST(LobeQuality, KnowsTheScatterOfPeriodograms) {
  EXPECT_NEAR(mean_root(1.0), 0.886226925, 1e-8);
  EXPECT_NEAR(mean_root(0.5), 0.75 * std::sqrt(3.14159265358979 / 2.0), 1e-8);
  EXPECT_NEAR(mean_root(1e-3), 1.0 - 1.25e-4, 1e-7);
}

// The true spectrum itself is the perfect model. Its distance from a periodogram is that of speckle alone,
// and it is never called weak.
TEST(LobeQuality, ThePerfectModelIsNeverWeak) {
  int weak = 0, count = 0;
  double perfect = 0.0;
  for (const testing::NamedSpectrum& truth : testing::known_spectra()) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed, ++count) {
      const PowerSpectrum periodogram = power_spectrum(testing::draw_realisation(truth.spectrum, seed));
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
    const PowerSpectrum periodogram = power_spectrum(testing::draw_realisation(truth, seed));
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
    const GreyImage exemplar = testing::draw_realisation(truth.spectrum, 1);
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
  const PowerSpectrum periodogram = power_spectrum(testing::draw_realisation(testing::steep_spectrum(), 1));
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

std::vector<SpectralLobe> three_lobes() {
  return {{4, 0.1, 0.05, 3.0}, {3, -0.2, 0.25, 1.0}, {5, 0.3, 0.0, 0.4}};
}

const std::vector<double> evenly(64 * 64, 1.0);

// The integral of a pair of Gaussians: 2 * height * 2 pi deviation^2 over a unit square of frequencies.
TEST(LobeVariance, IsTheIntegralOfThePair) {
  const SpectralLobe lobe{4, 0.1, 0.05, 3.0};
  const double deviation = lobe_deviation(4);
  EXPECT_NEAR(lobe_variance(lobe, 128, 96), 2.0 * 3.0 * 2.0 * 3.14159265358979 * deviation * deviation, 1e-9);
  EXPECT_NEAR(lobe_sum({lobe}, 128, 96).variance(), lobe_variance(lobe, 128, 96), 1e-6);
}

TEST(SpectrumOf, PeaksWhereTheLobeIsAtItsHeight) {
  const PowerSpectrum s = lobe_sum({{5, 8.0 / 64, -4.0 / 48, 2.5}}, 64, 48);
  EXPECT_NEAR(s.power[44 * 64 + 8], 2.5, 1e-9);
  EXPECT_NEAR(s.power[4 * 64 + 56], 2.5, 1e-9);
}

TEST(SelectLobes, TakesAwayTheShrinkageOfThePenalty) {
  const PowerSpectrum truth = lobe_sum(three_lobes(), 64, 64);
  std::vector<SpectralLobe> shrunk = three_lobes();
  for (SpectralLobe& lobe : shrunk) lobe.height *= 0.6;
  const std::vector<SpectralLobe> refitted = select_lobes(shrunk, truth, evenly, 80);
  ASSERT_EQ(refitted.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(refitted[i].height, three_lobes()[i].height, 1e-3);
}

TEST(SelectLobes, RemovesTheOneThatMattersLeast) {
  std::vector<SpectralLobe> lobes = three_lobes();
  lobes.push_back({5, -0.1, 0.35, 1e-3});
  const PowerSpectrum truth = lobe_sum(lobes, 64, 64);
  const std::vector<SpectralLobe> kept = select_lobes(lobes, truth, evenly, 3);
  ASSERT_EQ(kept.size(), 3u);
  for (const SpectralLobe& lobe : kept) EXPECT_GT(lobe.height, 0.1);
}

// Two lobes a fraction of a deviation apart can replace each other, so one of them is removed first.
TEST(SelectLobes, MergesNeighbours) {
  std::vector<SpectralLobe> lobes = three_lobes();
  lobes.push_back({4, 0.1 + 0.1 * lobe_deviation(4), 0.05, 1.5});
  const PowerSpectrum truth = lobe_sum(lobes, 64, 64);
  const std::vector<SpectralLobe> kept = select_lobes(lobes, truth, evenly, 3);
  ASSERT_EQ(kept.size(), 3u);
  EXPECT_LT(optimal_transport_distance(lobe_sum(kept, 64, 64), truth), 0.05);
}

}  // namespace
}  // namespace astrolith
