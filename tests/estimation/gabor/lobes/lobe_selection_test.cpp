#include "estimation/gabor/lobes/lobe_selection.h"

#include "estimation/gabor/spectrum/spectrum_distance.h"
#include "tests/estimation/gabor/known_spectrum.h"

namespace astrolith {
namespace {

using testing::sum_of;

std::vector<SpectralLobe> three_lobes() {
  return {{4, 0.1, 0.05, 3.0}, {3, -0.2, 0.25, 1.0}, {5, 0.3, 0.0, 0.4}};
}

const std::vector<double> evenly(64 * 64, 1.0);

// The integral of a pair of Gaussians: 2 * height * 2 pi deviation^2 over a unit square of frequencies.
TEST(LobeVariance, IsTheIntegralOfThePair) {
  const SpectralLobe lobe{4, 0.1, 0.05, 3.0};
  const double deviation = lobe_deviation(4);
  EXPECT_NEAR(lobe_variance(lobe, 128, 96), 2.0 * 3.0 * 2.0 * 3.14159265358979 * deviation * deviation, 1e-9);
  EXPECT_NEAR(sum_of({lobe}, 128, 96).variance(), lobe_variance(lobe, 128, 96), 1e-6);
}

TEST(SpectrumOf, PeaksWhereTheLobeIsAtItsHeight) {
  const PowerSpectrum s = sum_of({{5, 8.0 / 64, -4.0 / 48, 2.5}}, 64, 48);
  EXPECT_NEAR(s.power[44 * 64 + 8], 2.5, 1e-9);
  EXPECT_NEAR(s.power[4 * 64 + 56], 2.5, 1e-9);
}

TEST(SelectLobes, TakesAwayTheShrinkageOfThePenalty) {
  const PowerSpectrum truth = sum_of(three_lobes(), 64, 64);
  std::vector<SpectralLobe> shrunk = three_lobes();
  for (SpectralLobe& lobe : shrunk) lobe.height *= 0.6;
  const std::vector<SpectralLobe> refitted = select_lobes(shrunk, truth, evenly, 80);
  ASSERT_EQ(refitted.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(refitted[i].height, three_lobes()[i].height, 1e-3);
}

TEST(SelectLobes, RemovesTheOneThatMattersLeast) {
  std::vector<SpectralLobe> lobes = three_lobes();
  lobes.push_back({5, -0.1, 0.35, 1e-3});
  const PowerSpectrum truth = sum_of(lobes, 64, 64);
  const std::vector<SpectralLobe> kept = select_lobes(lobes, truth, evenly, 3);
  ASSERT_EQ(kept.size(), 3u);
  for (const SpectralLobe& lobe : kept) EXPECT_GT(lobe.height, 0.1);
}

// Two lobes a fraction of a deviation apart can replace each other, so one of them is removed first.
TEST(SelectLobes, MergesNeighbours) {
  std::vector<SpectralLobe> lobes = three_lobes();
  lobes.push_back({4, 0.1 + 0.1 * lobe_deviation(4), 0.05, 1.5});
  const PowerSpectrum truth = sum_of(lobes, 64, 64);
  const std::vector<SpectralLobe> kept = select_lobes(lobes, truth, evenly, 3);
  ASSERT_EQ(kept.size(), 3u);
  EXPECT_LT(optimal_transport_distance(sum_of(kept, 64, 64), truth), 0.05);
}

}  // namespace
}  // namespace astrolith
