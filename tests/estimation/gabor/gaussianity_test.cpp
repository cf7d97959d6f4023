#include "estimation/gabor/gaussianity.h"

#include <cmath>

#include "estimation/gabor/image/image_reader.h"
#include "tests/estimation/gabor/known_spectrum.h"
#include "tests/support/data.h"

namespace astrolith {
namespace {

TEST(Gaussianity, OfAGaussianTextureIsPlausible) {
  const PowerSpectrum spectrum = testing::four_lobe_spectrum();
  int rejected = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    const Gaussianity g = test_gaussianity(testing::realisation_of(spectrum, seed), 1);
    EXPECT_TRUE(g.plausible());
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
  EXPECT_FALSE(g.plausible());
  EXPECT_NE(g.sentence.find("lopsided"), std::string::npos);
}

// A Gaussian texture that is strong on the left and weak on the right.
TEST(Gaussianity, SeesDetailThatSitsInPlaces) {
  GreyImage image = testing::realisation_of(testing::four_lobe_spectrum(), 2);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      image.values[static_cast<std::size_t>(y * image.width + x)] *= x < 64 ? 1.0 : 0.2;
    }
  }
  const Gaussianity g = test_gaussianity(image, 1);
  EXPECT_GT(g.variance_spread, 2.0);
  EXPECT_LE(g.p_value, 0.01);
  EXPECT_NE(g.likeness, Likeness::kGaussian);
  EXPECT_NE(g.likeness, Likeness::kClose);
}

// Sharp-edged cells with a Gaussian marginal, which only the phases reveal.
TEST(Gaussianity, SeesEdgesUnderAGaussianMarginal) {
  GreyImage image{128, 128, {}};
  CounterRandom random(4);
  std::vector<double> cells(8 * 8);
  for (double& c : cells) c = random.normal();
  for (int y = 0; y < 128; ++y) {
    for (int x = 0; x < 128; ++x)
      image.values.push_back(cells[static_cast<std::size_t>(y / 16 * 8 + x / 16)]);
  }
  const Gaussianity g = test_gaussianity(image, 1);
  EXPECT_GT(g.edge_kurtosis, 3.0);
  EXPECT_EQ(g.likeness, Likeness::kOutside);
  EXPECT_NE(g.sentence.find("edges"), std::string::npos) << g.sentence;
}

TEST(Gaussianity, FlagsBricksAndPaving) {
  for (const char* name : {"STRUCT_brick_skimage_512.png", "STRUCT_paving_height_ambientcg_2048.png"}) {
    const auto file = testing::shared_texture(name);
    ASTROLITH_SKIP_WITHOUT(file);
    const Gaussianity g = test_gaussianity(read_grey_image(file).image, 1);
    EXPECT_EQ(g.likeness, Likeness::kOutside) << name << ": " << g.sentence;
    EXPECT_EQ(g.p_value, 0.01);
  }
}

}  // namespace
}  // namespace astrolith
