#include "estimation/gabor/spectrum/border_taper.h"

#include <cmath>

#include "estimation/gabor/spectrum/spectrum_distance.h"
#include "estimation/gabor/spectrum/spectrum_estimate.h"
#include "tests/estimation/gabor/known_spectrum.h"

namespace astrolith {
namespace {

GreyImage corner_of(const GreyImage& image, int side) {
  GreyImage corner{side, side, {}};
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) corner.values.push_back(image.at(x, y));
  }
  return corner;
}

double variance_of(const GreyImage& image) { return power_spectrum(image).variance(); }

TEST(BorderTaper, TellsATileFromACut) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    for (const PowerSpectrum& s : {testing::four_lobe_spectrum(), testing::steep_spectrum()}) {
      const GreyImage tile = testing::realisation_of(s, seed);
      EXPECT_TRUE(tiles_along_x(tile));
      EXPECT_TRUE(tiles_along_y(tile));
      EXPECT_FALSE(tiles_along_x(corner_of(tile, 64)));
      EXPECT_FALSE(tiles_along_y(corner_of(tile, 64)));
    }
  }
}

TEST(BorderTaper, LeavesATileAsItIs) {
  const GreyImage tile = testing::realisation_of(testing::four_lobe_spectrum(), 2);
  const TaperedImage tapered = taper_borders(tile);
  EXPECT_DOUBLE_EQ(tapered.looks, 1.0);
  const PowerSpectrum before = power_spectrum(tile);
  const PowerSpectrum after = power_spectrum(tapered.image);
  EXPECT_LT(optimal_transport_distance(after, before), 1e-6);
}

TEST(BorderTaper, FadesACutAndKeepsItsVariance) {
  const GreyImage cut = corner_of(testing::realisation_of(testing::steep_spectrum(), 3), 70);
  const TaperedImage tapered = taper_borders(cut);
  EXPECT_NEAR(variance_of(tapered.image), variance_of(cut), 1e-9 * variance_of(cut));
  EXPECT_LT(std::abs(tapered.image.at(0, 35)), 0.1 * std::sqrt(variance_of(cut)));
  EXPECT_GT(tapered.looks, 0.7);
  EXPECT_LT(tapered.looks, 1.0);
}

// The taper's estimate from a square cut out of a larger texture is nearer to the truth than that from the
// periodic component.
TEST(BorderTaper, ServesCutsBetterThanThePeriodicComponent) {
  double taper = 0.0;
  double periodic = 0.0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const testing::CutTexture cut = testing::cut_realisation(testing::ring_power, seed);
    taper += optimal_transport_distance(
        estimate_spectrum(exemplar_periodogram(cut.image, 1024, Borders::kTaper)).spectrum, cut.truth);
    periodic += optimal_transport_distance(
        estimate_spectrum(exemplar_periodogram(cut.image, 1024, Borders::kPeriodicComponent)).spectrum,
        cut.truth);
  }
  EXPECT_LT(taper, 0.9 * periodic);
}

}  // namespace
}  // namespace astrolith
