#include "estimation/gabor/exemplar/exemplar_preparation.h"

#include <algorithm>

#include "numerics/errors.h"
#include "numerics/hash_random.h"

namespace astrolith {
namespace {

// Discs of two grey levels on a ramp of light: far from Gaussian, and not periodic.
GreyImage discs(int side) {
  GreyImage image{side, side, std::vector<double>(static_cast<std::size_t>(side * side))};
  CounterRandom random(3);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      image.values[static_cast<std::size_t>(y * side + x)] = 0.2 + 0.05 * x / side + 0.02 * random.uniform();
    }
  }
  for (int disc = 0; disc < side * side / 60; ++disc) {
    const double cx = random.uniform(0, side), cy = random.uniform(0, side), grey = random.uniform(0.4, 0.9);
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        if ((x - cx) * (x - cx) + (y - cy) * (y - cy) < 9.0) {
          image.values[static_cast<std::size_t>(y * side + x)] = grey;
        }
      }
    }
  }
  return image;
}

TEST(TextureScore, IsZeroForTheSameImageAndKnowsShifts) {
  const GreyImage image = discs(96);
  EXPECT_EQ(texture_score(image, image).sum(), 0.0);
  GreyImage shifted = image;
  double mean = 0.0, square = 0.0;
  for (const double v : image.values) mean += v / static_cast<double>(image.values.size());
  for (const double v : image.values)
    square += (v - mean) * (v - mean) / static_cast<double>(image.values.size());
  for (double& v : shifted.values) v += 0.25 * std::sqrt(square);
  const TextureScore score = texture_score(shifted, image);
  EXPECT_NEAR(score.values, 0.25, 1e-9);
  EXPECT_NEAR(score.filters, 0.0, 1e-9);
}

TEST(ExemplarPreparation, TakesTheVariantWithTheBestScore) {
  const GreyImage photo = discs(128);
  const PreparedExemplar prepared = prepare_exemplar(photo, "p", 1);
  for (const auto& score : prepared.scores) EXPECT_LE(prepared.score().sum(), score.value().sum());
  EXPECT_EQ(prepared.layer.border == ExemplarBorder::kMirror, prepared.variant == ExemplarVariant::kMirrored);
  EXPECT_LT(prepared.score().values + prepared.score().filters, 0.25);
  const PreparedExemplar matched = prepare_exemplar(photo, "p", 1, {}, ExemplarVariant::kMatched);
  EXPECT_EQ(matched.variant, ExemplarVariant::kMatched);
  EXPECT_FALSE(matched.scores[0] || matched.scores[2]);
  EXPECT_EQ(matched.score().sum(), prepared.scores[1]->sum());
}

// Bands at a slant under light that falls off: mirrored they would run both ways, with the same distributions
// of the slopes along x and y.
TEST(ExemplarPreparation, KeepsTheDirectionOfAPhoto) {
  GreyImage bands{128, 128, {}};
  CounterRandom random(5);
  std::vector<double> phases;
  for (int k = 0; k < 40; ++k) phases.push_back(random.uniform(0, 6.28));
  for (int y = 0; y < bands.height; ++y) {
    for (int x = 0; x < bands.width; ++x) {
      double sum = 0.003 * x;
      for (int k = 0; k < 40; ++k)
        sum += 0.1 *
               std::sin((x - y) * 0.02 * (k + 3) + (x + y) * 0.002 * k + phases[static_cast<std::size_t>(k)]);
      bands.values.push_back(sum);
    }
  }
  const double photo = OrientedSlopes(bands, 128).correlation();
  EXPECT_LT(photo, -0.7);
  const auto correlation_of = [&](const PreparedExemplar& prepared) {
    return OrientedSlopes(exemplar_texture_like(prepared.layer, bands, 2), 128).correlation();
  };
  EXPECT_NEAR(correlation_of(prepare_exemplar(bands, "p", 1)) / photo, 1.0, 0.2);
  const PreparedExemplar mirrored = prepare_exemplar(bands, "p", 1, {}, ExemplarVariant::kMirrored);
  EXPECT_GT(mirrored.score().direction, 0.5);
}

// The image has the photo's colours, and its luma is the height.
TEST(ExemplarPreparation, KeepsTheColoursOfAPhoto) {
  GreyImage red = discs(96), green = red, blue = red;
  for (double& v : green.values) v = 0.1 + 0.7 * v;
  for (std::size_t i = 0; i < blue.values.size(); ++i) blue.values[i] = 0.5 - 0.2 * blue.values[i];
  const PreparedExemplar prepared = prepare_exemplar(std::vector<GreyImage>{red, green, blue}, "p", 1);
  const ExemplarImage& image = *prepared.layer.pixels;
  EXPECT_TRUE(prepared.layer.color);
  ASSERT_EQ(image.rgb.size(), 3 * image.values.size());
  double photo = 0.0, kept = 0.0;
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    const double luma =
        0.2126 * image.rgb[3 * i] + 0.7152 * image.rgb[3 * i + 1] + 0.0722 * image.rgb[3 * i + 2];
    ASSERT_NEAR(image.values[i], luma, 0.51);
    photo += blue.values[i] / static_cast<double>(image.values.size());
    kept += image.rgb[3 * i + 2] / 65535.0 / static_cast<double>(image.values.size());
  }
  EXPECT_NEAR(kept, photo, 1e-3);
  const PreparedExemplar grey =
      prepare_exemplar(luma_image(std::vector<GreyImage>{red, green, blue}), "p", 1);
  EXPECT_NEAR(grey.layer.height_rms / prepared.layer.height_rms, 1.0, 1e-3);
  blue.values[5] = 300.0;
  EXPECT_THROW(prepare_exemplar(std::vector<GreyImage>{red, green, blue}, "p", 1), InputError);
}

TEST(ExemplarPreparation, MovesItsProgressAndStops) {
  const GreyImage photo = discs(64);
  std::vector<double> fractions;
  const std::vector<GreyImage> planes(3, photo);
  prepare_exemplar(planes, "p", 1, [&](double fraction, std::string_view) {
    fractions.push_back(fraction);
    return true;
  });
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_GT(fractions.size(), 20u);
  for (std::size_t most = 0; most + 1 < fractions.size(); most += 5) {
    std::size_t count = 0;
    const auto stop = [&](double, std::string_view) { return count++ < most; };
    EXPECT_THROW(prepare_exemplar(planes, "p", 1, stop), WorkError) << most;
  }
}

TEST(ExemplarPreparation, RefusesPhotosThatAreTooSmallOrFlat) {
  EXPECT_THROW(prepare_exemplar(discs(24), "p", 1), InputError);
  EXPECT_THROW(prepare_exemplar({64, 64, std::vector<double>(4096, 0.5)}, "p", 1), InputError);
}

}  // namespace
}  // namespace astrolith
