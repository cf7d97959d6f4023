#include "estimation/gabor/gaussianity.h"

#include <cmath>

#include "estimation/gabor/image/image_reader.h"
#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "tests/estimation/gabor/known_spectrum.h"
#include "tests/support/data.h"

namespace astrolith {
namespace {

TEST(Gaussianity, OfAGaussianTextureIsPlausible) {
  const PowerSpectrum spectrum = testing::four_lobe_spectrum();
  int rejected = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    const Gaussianity g = test_gaussianity(testing::draw_realisation(spectrum, seed), 1);
    EXPECT_TRUE(g.plausible());
    rejected += g.p_value <= 0.05;
  }
  EXPECT_LE(rejected, 2);  // expected 0.3 of 6
}

TEST(Gaussianity, StopsWhenAsked) {
  const GreyImage image = testing::draw_realisation(testing::four_lobe_spectrum(), 1);
  for (const int last : {1, 3}) {
    int asked = 0;
    const auto stop = [&](double, std::string_view) { return ++asked < last; };
    EXPECT_THROW(test_gaussianity(image, 1, stop), WorkError);
    EXPECT_EQ(asked, last);
  }
}

TEST(Gaussianity, SeesALopsidedMarginal) {
  GreyImage image = testing::draw_realisation(testing::four_lobe_spectrum(), 1);
  for (double& v : image.values) v = std::exp(v);
  const Gaussianity g = test_gaussianity(image, 1);
  EXPECT_GT(g.skewness, 1.0);
  EXPECT_LE(g.p_value, 0.01);
  EXPECT_FALSE(g.plausible());
  EXPECT_NE(g.sentence.find("lopsided"), std::string::npos);
}

// A Gaussian texture that is strong on the left and weak on the right.
TEST(Gaussianity, SeesDetailThatSitsInPlaces) {
  GreyImage image = testing::draw_realisation(testing::four_lobe_spectrum(), 2);
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

// A Gaussian texture of 1024 x 1024 pixels, of realisations of 128 x 128 pixels side by side.
GreyImage large_texture(std::uint64_t seed) {
  constexpr int kSide = 1024, kPiece = 128;
  GreyImage image{kSide, kSide, std::vector<double>(kSide * kSide)};
  const PowerSpectrum spectrum = testing::broad_spectrum();
  for (int ty = 0; ty < kSide / kPiece; ++ty) {
    for (int tx = 0; tx < kSide / kPiece; ++tx) {
      const GreyImage piece =
          testing::draw_realisation(spectrum, 1000 * seed + static_cast<std::uint64_t>(ty * kSide + tx));
      for (int y = 0; y < kPiece; ++y) {
        for (int x = 0; x < kPiece; ++x)
          image.values[static_cast<std::size_t>((ty * kPiece + y) * kSide + tx * kPiece + x)] =
              piece.at(x, y);
      }
    }
  }
  return image;
}

bool in_the_middle(int x, int y) { return std::max(std::abs(x - 512), std::abs(y - 512)) < 260; }

TEST(Gaussianity, SeesEdgesOutsideTheMiddleOfALargePhotoLong) {
  GreyImage image = large_texture(1);
  EXPECT_TRUE(test_gaussianity(image, 1).plausible());
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (in_the_middle(x, y)) continue;
      double& v = image.values[static_cast<std::size_t>(y * image.width + x)];
      v = 0.1 * v + ((x / 40 + y / 40) % 7 == 0 ? 4.0 : -0.5);
    }
  }
  const Gaussianity g = test_gaussianity(image, 1);
  EXPECT_EQ(g.likeness, Likeness::kOutside);
  EXPECT_GT(g.edge_kurtosis, 3.0);
  EXPECT_LE(g.p_value, 0.05);
}

// The texture is Gaussian everywhere, and weak outside the middle.
TEST(Gaussianity, SeesThatTheBorderOfALargePhotoIsWeakerLong) {
  GreyImage image = large_texture(2);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (!in_the_middle(x, y)) image.values[static_cast<std::size_t>(y * image.width + x)] *= 0.2;
    }
  }
  const Gaussianity g = test_gaussianity(image, 1);
  EXPECT_GT(g.variance_spread, 2.0);
  EXPECT_LE(g.p_value, 0.01);
  EXPECT_NE(g.likeness, Likeness::kGaussian);
}

TEST(Gaussianity, OfAPhotoLargerThanAPieceIsTheSameForAnyThreadCount) {
  GreyImage image = large_texture(3);
  image.width = 1000;
  image.height = 600;
  image.values.resize(1000 * 600);
  const auto with = [&](int threads) {
    const ThreadLimit limit(threads);
    return test_gaussianity(image, 1);
  };
  const Gaussianity one = with(1), two = with(2);
  EXPECT_EQ(one.p_value, two.p_value);
  EXPECT_EQ(one.edge_kurtosis, two.edge_kurtosis);
  EXPECT_EQ(one.variance_spread, two.variance_spread);
}

TEST(Gaussianity, FlagsBricksAndPaving) {
  for (const char* name : {"STRUCT_brick_skimage_512.png", "STRUCT_paving_height_ambientcg_2048.png"}) {
    const auto file = testing::shared_texture(name);
    ASTROLITH_SKIP_WITHOUT(file);
    const Gaussianity g = test_gaussianity(read_image(file, false).planes[0], 1);
    EXPECT_EQ(g.likeness, Likeness::kOutside) << name << ": " << g.sentence;
    EXPECT_EQ(g.p_value, 0.01);
  }
}

}  // namespace
}  // namespace astrolith
