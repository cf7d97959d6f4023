#include "synthesis/gabor/color_texture.h"

#include <array>

namespace astrolith {
namespace {

GaborLayer colored(Vec3d axis, Vec3d mean, double rms) {
  GaborLayer layer;
  layer.exemplar_rms = rms;
  layer.color = LayerColor{axis, mean};
  layer.lobes = {{2, 0.2, 0.1, 1.0}};
  return layer;
}

// The covariance of the colours is the sum over the layers of rms^2 axis axis'.
TEST(ColorTexture, HasTheStatedMeanAndCovariance) {
  const std::vector<GaborLayer> layers{colored({0.6, 0.8, 0}, {0.5, 0.4, 0.3}, 0.2),
                                       colored({-0.8, 0.6, 0}, {}, 0.05), colored({0, 0, 1}, {}, 0.1)};
  const std::vector<float> rgb = synthesize_color_texture(layers, 512, 512, {3});
  const double n = 512 * 512;
  std::array<double, 3> mean{};
  std::array<std::array<double, 3>, 3> product{};
  for (std::size_t i = 0; i < rgb.size(); i += 3) {
    for (std::size_t a = 0; a < 3; ++a) {
      mean[a] += static_cast<double>(rgb[i + a]) / n;
      for (std::size_t b = 0; b < 3; ++b)
        product[a][b] += static_cast<double>(rgb[i + a]) * static_cast<double>(rgb[i + b]) / n;
    }
  }
  const double expected[3][3] = {{0.36 * 0.04 + 0.64 * 0.0025, 0.48 * 0.04 - 0.48 * 0.0025, 0},
                                 {0.48 * 0.04 - 0.48 * 0.0025, 0.64 * 0.04 + 0.36 * 0.0025, 0},
                                 {0, 0, 0.01}};
  const double means[3] = {0.5, 0.4, 0.3};
  for (std::size_t a = 0; a < 3; ++a) {
    EXPECT_NEAR(mean[a], means[a], 0.002);
    for (std::size_t b = 0; b < 3; ++b) {
      EXPECT_NEAR(product[a][b] - mean[a] * mean[b], expected[a][b], 4e-4) << a << b;
    }
  }
}

TEST(ColorTexture, OnlyColouredLayersPaint) {
  Recipe recipe;
  recipe.layers = {GaborLayer{}, colored({1, 0, 0}, {}, 0.1), FractalLayer{}};
  EXPECT_EQ(colored_layers(recipe).size(), 1u);
}

TEST(ColorTexture, LayersAreIndependentAndTile) {
  const std::vector<GaborLayer> layers{colored({1, 0, 0}, {}, 1.0), colored({0, 1, 0}, {}, 1.0)};
  const std::vector<float> rgb = synthesize_color_texture(layers, 200, 100, {1, 0, 100, 50});
  double product = 0.0;
  for (std::size_t y = 0; y < 100; ++y) {
    for (std::size_t x = 0; x < 200; ++x) {
      const std::size_t i = 3 * (y * 200 + x), j = 3 * (y % 50 * 200 + x % 100);
      EXPECT_NEAR(rgb[i], rgb[j], 2e-5f);
      product += static_cast<double>(rgb[i]) * static_cast<double>(rgb[i + 1]) / 20000;
    }
  }
  EXPECT_NEAR(product, 0.0, 0.1);
}

}  // namespace
}  // namespace astrolith
