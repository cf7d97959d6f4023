#include "estimation/gabor/spectrum/border_taper.h"

#include <cmath>

#include "estimation/gabor/spectrum/spectrum_distance.h"
#include "numerics/sample_statistics.h"
#include "tests/estimation/gabor/known_spectrum.h"

namespace astrolith {
namespace {

// The decision is statistical: the cut of one of these textures continues by chance.
TEST(BorderTaper, TellsAPeriodFromACut) {
  int false_cuts = 0, false_periods = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    for (const PowerSpectrum& s : {testing::four_lobe_spectrum(), testing::steep_spectrum()}) {
      const GreyImage period = testing::realisation_of(s, seed), cut = period.part(0, 0, 64, 64);
      false_cuts += !repeats_along_x(period) + !repeats_along_y(period);
      false_periods += repeats_along_x(cut) + repeats_along_y(cut);
    }
  }
  EXPECT_EQ(false_cuts, 0);     // of 20
  EXPECT_LE(false_periods, 1);  // of 20
}

// One bright layer of rock, or one bright grain, bends the image more than a cut border does.
TEST(BorderTaper, OneStrongStratumOrGrainDoesNotHideACut) {
  int false_periods = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    for (const PowerSpectrum& s : {testing::four_lobe_spectrum(), testing::steep_spectrum()}) {
      const GreyImage cut = testing::realisation_of(s, seed).part(0, 0, 64, 64);
      GreyImage upright = cut, level = cut, grain = cut;
      for (int i = 0; i < 64; ++i) {
        upright.values[static_cast<std::size_t>(i * 64 + 20)] += 10.0;
        level.values[static_cast<std::size_t>(41 * 64 + i)] -= 10.0;
      }
      grain.values[30 * 64 + 37] += 200.0;
      false_periods +=
          repeats_along_x(upright) + repeats_along_y(level) + repeats_along_x(grain) + repeats_along_y(grain);
    }
  }
  EXPECT_LE(false_periods, 2);  // of 40; the cut that continues by chance is taken for a period twice
}

TEST(BorderTaper, AStrongStratumInAPeriodDoesNotHideIt) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    GreyImage period = testing::realisation_of(testing::steep_spectrum(), seed);
    for (int i = 0; i < period.height; ++i)
      period.values[static_cast<std::size_t>(i * period.width + 20)] += 10.0;
    EXPECT_TRUE(repeats_along_x(period) && repeats_along_y(period)) << seed;
  }
}

TEST(BorderTaper, LeavesAPeriodAsItIs) {
  const GreyImage period = testing::realisation_of(testing::four_lobe_spectrum(), 2);
  const BorderTaper taper = taper_of(period);
  EXPECT_DOUBLE_EQ(taper.looks(), 1.0);
  EXPECT_LT(optimal_transport_distance(power_spectrum(faded(period, taper)), power_spectrum(period)), 1e-6);
}

TEST(BorderTaper, FadesACut) {
  const GreyImage cut = testing::realisation_of(testing::steep_spectrum(), 3).part(0, 0, 70, 70);
  const BorderTaper taper = taper_of(cut);
  EXPECT_LT(std::abs(faded(cut, taper).at(0, 35)), 0.1 * std::sqrt(variance_of(cut.values)));
  EXPECT_GT(taper.looks(), 0.7);
  EXPECT_LT(taper.looks(), 1.0);
}

}  // namespace
}  // namespace astrolith
