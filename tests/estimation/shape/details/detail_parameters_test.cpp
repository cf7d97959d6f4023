#include "estimation/shape/details/detail_parameters.h"

#include "recipe/recipe_json.h"

namespace astrolith {
namespace {

DetailRanges some_ranges() { return {8.0, 80.0, 1e-5, 1e-2, 1.0}; }

TEST(DetailParameters, AreThirtyFourWithinTheirBounds) {
  const Bounds bounds = detail_bounds(some_ranges());
  ASSERT_EQ(bounds.lower.size(), kDetailParameters);
  for (std::size_t which = 0; which < 3; ++which) {
    const auto x = detail_parameters({which, 1e-3, 20.0, 3, 0.4}, some_ranges());
    ASSERT_EQ(x.size(), kDetailParameters);
    for (std::size_t d = 0; d < x.size(); ++d) {
      EXPECT_GE(x[d], bounds.lower[d]) << d;
      EXPECT_LE(x[d], bounds.upper[d]) << d;
    }
  }
}

TEST(DetailParameters, APlainNoiseBecomesOneLayer) {
  for (std::size_t which = 0; which < 3; ++which) {
    const auto layers =
        detail_layers(detail_parameters({which, 1e-3, 10.0, 3, 0.4}, some_ranges()), some_ranges());
    ASSERT_EQ(layers.size(), 1u);
    EXPECT_EQ(layers[0].noise, kDetailNoises[which]);
    EXPECT_NEAR(layers[0].amplitude * layers[0].weight, 1e-3, 1e-12);
    EXPECT_NEAR(layers[0].frequency, 10.0, 1e-9);
    EXPECT_EQ(layers[0].octaves, 3);
    EXPECT_EQ(layers[0].gain, 0.4);
    EXPECT_NEAR(norm(layers[0].scale - Vec3d{1, 1, 1}), 0.0, 1e-12);
  }
}

TEST(DetailParameters, NoOctaveIsFinerThanTheRangesAllow) {
  const auto layers = detail_layers(detail_parameters({0, 1e-3, 30.0, 8, 0.4}, some_ranges()), some_ranges());
  ASSERT_EQ(layers.size(), 1u);
  EXPECT_EQ(layers[0].octaves, 2);  // 30 and 58.5; 114 would be above 80
}

TEST(DetailParameters, SteepnessBoundsTheSlope) {
  FractalLayer layer;
  layer.amplitude = 0.01;
  layer.frequency = 10.0;
  layer.octaves = 2;
  layer.gain = 0.5;
  layer.lacunarity = 2.0;
  EXPECT_NEAR(steepness(std::vector<FractalLayer>{layer}), 2 * 7.0 * 0.1, 1e-12);
  EXPECT_EQ(steepness({}), 0.0);
}

TEST(DetailParameters, EveryCornerOfTheBoxIsAValidRecipe) {
  const Bounds bounds = detail_bounds(some_ranges());
  for (const auto& corner : {bounds.lower, bounds.upper}) {
    Recipe recipe;
    recipe.body.emplace().spheres.push_back({{0, 0, 0}, 1.0});
    for (const FractalLayer& layer : detail_layers(corner, some_ranges())) recipe.layers.push_back(layer);
    EXPECT_NO_THROW(validate_recipe(recipe, "corner"));
  }
}

}  // namespace
}  // namespace astrolith
