#include "estimation/gabor/gaussianity.h"

#include <cmath>

#include "tests/estimation/gabor/known_spectrum.h"

namespace astrolith {
namespace {

TEST(Gaussianity, OfAGaussianTextureIsPlausible) {
  const PowerSpectrum spectrum = testing::four_lobe_spectrum();
  int rejected = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    const Gaussianity g = test_gaussianity(testing::realisation_of(spectrum, seed), 1);
    EXPECT_TRUE(g.plausible);
    rejected += g.p_value <= 0.05;
  }
  EXPECT_LE(rejected, 2);  // expected 0.3 of 6
}

TEST(Gaussianity, SeesALopsidedMarginal) {
  GreyImage image = testing::realisation_of(testing::four_lobe_spectrum(), 1);
  for (double& v : image.values) v = std::exp(v);
  const Gaussianity g = test_gaussianity(image, 1);
  EXPECT_GT(g.skewness, 1.0);
  EXPECT_LE(g.p_value, 0.01);
  EXPECT_FALSE(g.plausible);
  EXPECT_NE(g.sentence.find("lopsided"), std::string::npos);
}

// The same values, but strong on the left and weak on the right.
TEST(Gaussianity, SeesDetailThatSitsInPlaces) {
  GreyImage image = testing::realisation_of(testing::four_lobe_spectrum(), 2);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      image.values[static_cast<std::size_t>(y * image.width + x)] *= x < 64 ? 1.0 : 0.2;
    }
  }
  const Gaussianity g = test_gaussianity(image, 1);
  EXPECT_GT(g.variance_spread, 2.0);
  EXPECT_FALSE(g.plausible);
}

}  // namespace
}  // namespace astrolith
