// Reliefs that hold their pixels in the recipe.
#include <gtest/gtest.h>

#include "numerics/errors.h"
#include "recipe/recipe_json.h"

namespace astrolith {
namespace {

// A relief of 40 x 30 pixels with an empty border.
Recipe with_relief(int levels = 91) {
  ReliefLayer layer;
  layer.spacing = 0.25;
  layer.low = -1.5, layer.high = 0.75;
  layer.levels = levels;
  ExemplarImage image{40, 30, std::vector<std::uint16_t>(1200, 0), {}};
  for (int y = 2; y < 28; ++y) {
    for (int x = 3; x < 36; ++x) {
      const int code = (x * x + 7 * y + 3 * x * y) % levels;
      image.values[static_cast<std::size_t>(40 * y + x)] = layer.value_of(static_cast<std::uint16_t>(code));
    }
  }
  layer.pixels = std::make_shared<ExemplarImage>(image);
  Recipe recipe;
  recipe.body = MetaballBody{};
  recipe.body->spheres = {{{}, 1.0}};
  recipe.layers = {layer};
  return recipe;
}

const ExemplarImage& pixels_of(const Recipe& recipe) {
  return *std::get<ReliefLayer>(recipe.layers[0]).pixels;
}

TEST(ReliefText, ComesBackFromJsonAndFromACompactRecipe) {
  for (const int levels : {2, 91, 65535}) {
    const Recipe recipe = with_relief(levels);
    const std::string json = recipe_to_json(recipe), compact = recipe_to_compact(recipe);
    EXPECT_LT(compact.size(), json.size());
    for (const std::string& text : {json, compact}) {
      const Recipe read = parse_recipe(text, "test");
      EXPECT_EQ(pixels_of(read).width, 40);
      EXPECT_EQ(pixels_of(read).values, pixels_of(recipe).values);
      EXPECT_EQ(recipe_to_json(read), json);
    }
  }
}

TEST(ReliefText, GreyValuesAndCodesAreEachOthers) {
  for (const int levels : {2, 3, 87, 4096, 65535}) {
    ReliefLayer layer;
    layer.levels = levels;
    for (int code = 0; code < levels; ++code) {
      const std::uint16_t value = layer.value_of(static_cast<std::uint16_t>(code));
      ASSERT_GT(value, 0);
      ASSERT_EQ(layer.code_of(value), code) << levels;
    }
    EXPECT_EQ(layer.value_of(static_cast<std::uint16_t>(levels - 1)), 65535);
  }
}

TEST(ReliefText, RefusesWhatIsDamagedOrMissing) {
  const std::string json = recipe_to_json(with_relief());
  const std::size_t at = json.find("\"heights\": \"") + 12;
  const auto refused = [](const std::string& text) {
    try {
      parse_recipe(text, "test");
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  std::string spoiled = json;
  spoiled[at + 5] = '*';
  EXPECT_NE(refused(spoiled).find("test: layers[0].heights: is damaged"), std::string::npos)
      << refused(spoiled);
  spoiled = json;
  spoiled.erase(at, json.find('"', at) - at);
  EXPECT_NE(refused(spoiled).find("layers[0]"), std::string::npos) << refused(spoiled);
  // Fewer levels than the codes have.
  spoiled = json;
  spoiled.replace(spoiled.find("\"levels\": 91"), 12, "\"levels\": 5");
  EXPECT_NE(refused(spoiled).find("layers[0].heights: is damaged"), std::string::npos) << refused(spoiled);
  const std::string compact = recipe_to_compact(with_relief());
  EXPECT_NE(refused(compact.substr(0, compact.size() - 40)), "");
}

}  // namespace
}  // namespace astrolith
