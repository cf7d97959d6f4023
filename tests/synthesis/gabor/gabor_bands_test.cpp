#include "synthesis/gabor/gabor_bands.h"

#include <cmath>

namespace astrolith {
namespace {

GaborLayer three_lobes() {
  GaborLayer layer;
  layer.lobes = {{4, 0.1, 0.0, 1.0}, {2, 0.0, 0.2, 6.0}, {4, -0.1, 0.3, 3.0}};
  return layer;
}

TEST(GaborBands, GroupLobesByBandwidth) {
  const std::vector<GaborBand> bands = gabor_bands(three_lobes());
  ASSERT_EQ(bands.size(), 2u);
  EXPECT_EQ(bands[0].bandwidth, 2);
  EXPECT_NEAR(bands[0].variance_share, 0.6, 1e-12);
  EXPECT_NEAR(bands[1].variance_share, 0.4, 1e-12);
  // The standard deviation of a lobe, 2^-b / (2 sqrt(2 ln 2)), equals a / (2 sqrt(pi)).
  EXPECT_NEAR(bands[1].a / (2 * std::sqrt(M_PI)), std::pow(2.0, -4) / (2 * std::sqrt(2 * std::log(2.0))),
              1e-9);
}

TEST(GaborBands, DrawLobesByTheirVariance) {
  const GaborBand band = gabor_bands(three_lobes())[1];
  EXPECT_FLOAT_EQ(band.draw(0.0f).frequency_x * static_cast<float>(band.a), 0.1f);
  EXPECT_EQ(&band.draw(0.2499f), &band.lobes[0]);
  EXPECT_EQ(&band.draw(0.25f), &band.lobes[1]);
  EXPECT_EQ(&band.draw(0.99999994f), &band.lobes[1]);
}

TEST(GaborBands, LobesWithoutVarianceAreNoLobes) {
  GaborLayer layer;
  layer.lobes = {{3, 0.1, 0.1, 0.0}};
  EXPECT_TRUE(gabor_bands(layer).empty());
}

}  // namespace
}  // namespace astrolith
