#include "estimation/gabor/lobes/lobe_refinement.h"

#include <cmath>

#include "estimation/gabor/lobes/lobe_misfit.h"
#include "estimation/gabor/spectrum/octaves.h"
#include "estimation/gabor/spectrum/spectrum_distance.h"
#include "numerics/parallel_for.h"
#include "tests/estimation/gabor/known_spectrum.h"

namespace astrolith {
namespace {

using testing::sum_of;

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
  const PowerSpectrum truth = sum_of(four_lobes(), 60, 48);
  const std::vector<SpectralLobe> lobes = disturbed(four_lobes());
  const LobeMisfit misfit(lobes, truth, equal_weights(truth));
  const std::vector<double> start(12, 0.0);
  EXPECT_NEAR(std::sqrt(misfit(start, {})), optimal_transport_distance(sum_of(lobes, 60, 48), truth), 1e-5);
}

TEST(LobeMisfit, GradientAgreesWithDifferences) {
  const PowerSpectrum truth = sum_of(four_lobes(), 60, 48);
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
  const PowerSpectrum truth = sum_of(four_lobes(), 64, 64);
  const std::vector<SpectralLobe> refined = refine_lobes(disturbed(four_lobes()), known(truth)).lobes;
  ASSERT_EQ(refined.size(), 4u);
  EXPECT_LT(optimal_transport_distance(sum_of(refined, 64, 64), truth), 0.01);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(refined[i].x, four_lobes()[i].x, 0.05 * lobe_deviation(refined[i].bandwidth));
    EXPECT_NEAR(refined[i].height, four_lobes()[i].height, 0.05 * four_lobes()[i].height);
  }
}

TEST(RefineLobes, ThreadsDoNotChangeABit) {
  const PowerSpectrum truth = sum_of(four_lobes(), 64, 48);
  const auto refined_with = [&](int threads) {
    const ThreadLimit limit(threads);
    return sum_of(refine_lobes(disturbed(four_lobes()), known(truth)).lobes, 64, 48).power;
  };
  EXPECT_EQ(refined_with(1), refined_with(4));
}

// Superfluous lobes are removed, and the lobes that carry the spectrum stay.
TEST(FewestLobes, KeepsWhatTheEstimateIsWorth) {
  const PowerSpectrum truth = sum_of(four_lobes(), 64, 64);
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
  EXPECT_LE(optimal_transport_distance(sum_of(few, 64, 64), truth), 0.03);
}

TEST(FewestLobes, KeepsTheLobesWhenAskedToStop) {
  const PowerSpectrum truth = sum_of(four_lobes(), 64, 64);
  int asked = 0;
  const auto stop = [&](double, std::string_view) { return ++asked < 4; };
  const RefinedLobes at_once = fewest_lobes(disturbed(four_lobes()), known(truth), equal_weights(truth),
                                            [](double, std::string_view) { return false; });
  const RefinedLobes soon = fewest_lobes(disturbed(four_lobes()), known(truth), equal_weights(truth), stop);
  EXPECT_FALSE(at_once.reached || soon.reached);
  EXPECT_EQ(at_once.lobes.size(), 4u);
  EXPECT_EQ(soon.lobes.size(), 4u);
  EXPECT_LT(optimal_transport_distance(sum_of(soon.lobes, 64, 64), truth),
            optimal_transport_distance(sum_of(at_once.lobes, 64, 64), truth));
  EXPECT_EQ(asked, 5);  // the loop asks once more after the minimisation has ended
}

}  // namespace
}  // namespace astrolith
