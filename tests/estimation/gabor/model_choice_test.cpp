#include "estimation/gabor/model_choice.h"

#include <algorithm>
#include <cmath>

#include "estimation/gabor/exemplar/exemplar_preparation.h"
#include "numerics/errors.h"
#include "tests/estimation/gabor/known_spectrum.h"

namespace astrolith {
namespace {

GreyImage gaussian_texture() { return testing::draw_realisation(testing::broad_spectrum(), 6); }

// Bright grains on a dark ground: two grey values, and edges, which no noise has.
GreyImage grains() {
  CounterRandom random(9);
  GreyImage image{256, 256, std::vector<double>(256 * 256, 0.1)};
  for (int n = 0; n < 700; ++n) {
    const int cx = static_cast<int>(random.uniform(0, 256)), cy = static_cast<int>(random.uniform(0, 256));
    for (int y = -4; y <= 4; ++y) {
      for (int x = -4; x <= 4; ++x) {
        if (x * x + y * y > 16) continue;
        image.values[static_cast<std::size_t>(((cy + y) & 255) * 256 + ((cx + x) & 255))] = 0.9;
      }
    }
  }
  return image;
}

TEST(ModelChoice, TakesTheSimplestForAGaussianTextureAndTheExemplarForGrains) {
  const ModelChoice noise = choose_model(gaussian_texture(), "noise", {}, 1),
                    stones = choose_model(grains(), "grains", {}, 1);
  EXPECT_EQ(noise.squares, 4);
  EXPECT_EQ(noise.side, 64);
  EXPECT_EQ(model_word(noise.taken), "gabor");
  EXPECT_EQ(model_word(stones.taken), "exemplar");
  for (const HeldOutScore& score : stones.scores) {
    EXPECT_GT(score.mean.values, 0.0);
    EXPECT_GT(score.scatter, 0.0);
  }
}

// One half is dark and the other bright, so no square has the grey values of all.
TEST(ModelChoice, SaysHowFarThePhotoDiffersFromItself) {
  const GreyImage noise = gaussian_texture();
  GreyImage halves = noise;
  for (std::size_t i = 0; i < halves.values.size(); ++i) {
    if (static_cast<int>(i) % halves.width >= halves.width / 2) halves.values[i] += 10.0;
  }
  EXPECT_LT(choose_model(noise, "noise", {}, 1).photo.mean.values, 0.3);
  EXPECT_GT(choose_model(halves, "halves", {}, 1).photo.mean.values, 1.0);
}

TEST(ModelChoice, ComparesNothingWhereThereIsTooLittle) {
  GreyImage one_corner{128, 128, std::vector<double>(128 * 128, 0.5)};
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x)
      one_corner.values[static_cast<std::size_t>(y * 128 + x)] += 0.01 * ((x * 7 + y * 13) % 11);
  }
  const GreyImage small{48, 200, std::vector<double>(48 * 200, 0.5)};
  for (const GreyImage& image : {one_corner, small}) {
    const ModelChoice choice = choose_model(image, "photo", {}, 1);
    EXPECT_EQ(choice.squares, 0);
    EXPECT_EQ(choice.taken, TextureModel::kGabor);
  }
}

// Stripes respond to filters along one axis only, and a ramp has no texture.
TEST(ModelChoice, IsFiniteForStripesAndComparesNoRamps) {
  GreyImage stripes{128, 128, {}}, ramp{128, 128, {}};
  for (int i = 0; i < 128 * 128; ++i) {
    stripes.values.push_back(0.5 + 0.2 * std::sin(0.7 * (i % 128)));
    ramp.values.push_back(0.005 * (i % 128) + 0.002 * (i / 128));
  }
  for (const HeldOutScore& score : choose_model(stripes, "stripes", {}, 1).scores) {
    EXPECT_TRUE(std::isfinite(score.mean.sum()) && std::isfinite(score.scatter));
  }
  EXPECT_EQ(choose_model(ramp, "ramp", {}, 1).squares, 0);
  EXPECT_THROW(fit_gabor_lobes(ramp, "ramp", {}), InputError);
}

TEST(ModelChoice, StopsWhenAsked) {
  EXPECT_THROW(
      choose_model(gaussian_texture(), "noise", {}, 1, [](double, std::string_view) { return false; }),
      WorkError);
}

}  // namespace
}  // namespace astrolith
