#include "estimation/gabor/exemplar/tiled_spectrum.h"

#include <cmath>

#include "estimation/gabor/spectrum/spectrum_distance.h"
#include "synthesis/exemplar/phase_tile.h"

namespace astrolith {
namespace {

TEST(AnchorCorrelation, FallsFromOneToNothing) {
  const AnchorCorrelation correlation;
  EXPECT_NEAR(correlation.at(0.0), 1.0, 1e-6);
  // The blur that the tiles take off their lobes.
  EXPECT_NEAR(correlation.at(0.2), std::exp(-2.0 * std::pow(0.2 * M_PI * kPhaseTileBlur, 2)), 0.005);
  for (double d = 0.05; d < 1.5; d += 0.05) EXPECT_LT(correlation.at(d), correlation.at(d - 0.05));
  EXPECT_LT(correlation.at(1.75), 1e-3);
  EXPECT_EQ(correlation.at(2.0), 0.0);
}

// Tiles keep the variance, and wide lobes their shape.
TEST(TiledSpectrum, IsNearTheLobes) {
  for (const std::vector<GaborLobe>& lobes : std::vector<std::vector<GaborLobe>>{
           {{3, 0.1, 0.05, 1.0}}, {{4, 0.0, 0.0, 2.0}}, {{6, 0.1, -0.1, 1.0}, {3, 0.05, 0.0, 3.0}}}) {
    const PowerSpectrum tiles = tiled_spectrum(lobes, 256, 192), truth = lobe_spectrum(lobes, 256, 192);
    EXPECT_NEAR(tiles.variance() / truth.variance(), 1.0, 0.01);
    const double distance = tiles_distance(lobes, 256, 192);
    EXPECT_GT(distance, 0.0);
    EXPECT_LT(distance, 0.07);
    EXPECT_DOUBLE_EQ(distance, optimal_transport_distance(tiles, truth));
  }
}

// A lobe that no tile holds is exact.
TEST(TiledSpectrum, OfNarrowLobesIsExact) { EXPECT_EQ(tiles_distance({{8, 0.5, 0.25, 1.0}}, 64, 64), 0.0); }

}  // namespace
}  // namespace astrolith
