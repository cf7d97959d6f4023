#include "synthesis/finish/known_population.h"

#include <cmath>

#include "numerics/errors.h"
#include "recipe/recipe_json.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/finish/known_albedo.h"
#include "synthesis/landforms/boulder_field.h"
#include "synthesis/landforms/population.h"
#include "tests/support/refusal.h"
#include "tests/synthesis/bodies.h"
#include "tests/synthesis/reliefs.h"

namespace astrolith {
namespace {

Recipe ball(double radius, const std::string& unit) {
  Recipe recipe = testing::sphere_recipe(radius);
  recipe.length_unit = unit;
  return recipe;
}

std::string refusal(const Recipe& recipe, const FinishRequest& request) {
  return testing::refusal_text([&] { finish_recipe(recipe, "r.json", request); });
}

TEST(KnownPopulation, HasThePublishedNumbers) {
  const auto number = [](std::string_view name, bool craters, double diameter) {
    for (const KnownBody& body : known_bodies()) {
      if (body.name != name) continue;
      for (const KnownLandforms& k : body.landforms) {
        if (k.craters == craters && diameter >= k.least && diameter < k.greatest)
          return known_number(k, diameter);
      }
    }
    return 0.0;
  };
  EXPECT_NEAR(number("itokawa", false, 5.0) * 0.393, 373.0, 1.0);
  EXPECT_NEAR(number("itokawa", false, 1.0) / number("itokawa", false, 5.0), std::pow(5.0, 3.05), 1e-6);
  EXPECT_NEAR(number("ryugu", false, 5.0) * 2.7, 4400.0, 5.0);
  EXPECT_NEAR(number("eros", false, 15.0) * 1124.0, 6760.0, 10.0);
  EXPECT_NEAR(number("eros", true, 20.0), 40.0, 1e-9);
  EXPECT_NEAR(number("eros", true, 99.999), 4.0, 0.05);  // R = 0.08
  EXPECT_NEAR(number("bennu", true, 2.5) * 0.7485, 1560.0, 10.0);
  EXPECT_EQ(number("bennu", true, 2.0), 0.0);
  EXPECT_NEAR(number("dimorphos", false, 5.0) / number("itokawa", false, 5.0), 5.1, 0.01);
  EXPECT_NEAR(number("dimorphos", false, 5.0) / number("bennu", false, 5.0), 3.5, 0.01);
  EXPECT_NEAR(number("dimorphos", false, 1.0) / number("bennu", false, 1.0), 2.3, 0.01);
}

// The density of a layer is that of its sizes alone, whatever the unit, and the layers are valid.
TEST(KnownPopulation, LayersHaveTheDensityOfTheirSizes) {
  for (const KnownBody& body : known_bodies()) {
    const Finish in_m = finish_recipe(ball(250.0, "m"), "r", {std::string(body.name), 12.0, 0.05});
    const Finish in_km = finish_recipe(ball(0.25, "km"), "r", {std::string(body.name), 0.012, 5e-5});
    validate_recipe(in_m.recipe, "m");
    validate_recipe(in_km.recipe, "km");
    ASSERT_EQ(in_m.layers.size(), in_km.layers.size());
    for (std::size_t i = 0; i < in_m.layers.size(); ++i) {
      const FinishLayer& layer = in_m.layers[i];
      const double number =
          known_number(layer.known, layer.least) - known_number(layer.known, layer.greatest);
      EXPECT_NEAR(layer.density, 1e-6 * number, 1e-5 * layer.density) << body.name;
      EXPECT_NEAR(1e-6 * in_km.layers[i].density, layer.density, 1e-5 * layer.density);
      // The law between the limits is the body's.
      const Population& drawn = *find_population(in_m.recipe.layers[static_cast<std::size_t>(layer.layer)]);
      const double middle = std::sqrt(layer.least * layer.greatest);
      const double below = known_number(layer.known, layer.least) - known_number(layer.known, middle);
      EXPECT_NEAR(share_below(drawn, middle), below / number, 1e-4) << body.name;
    }
  }
}

// Sizes meet without a gap: each layer begins where the one before it ends.
TEST(KnownPopulation, SizesMeet) {
  const Finish finish = finish_recipe(ball(70.0, "m"), "r", {"dimorphos", 8.0, 0.05});
  ASSERT_EQ(finish.layers.size(), 3u);  // above 5 m, below that but above 1/32 of the body, by cells
  EXPECT_DOUBLE_EQ(finish.layers[0].greatest, 8.0);
  EXPECT_DOUBLE_EQ(finish.layers.back().least, 0.05);
}

TEST(KnownPopulation, BeginsAtTheFinestSizeOfTheRecipe) {
  Recipe recipe = ball(250.0, "m");
  EXPECT_DOUBLE_EQ(finest_size(recipe), 500.0);
  BoulderLayer boulders;
  boulders.population.emplace().drawn = {100, std::nullopt, 6.0, 20.0, 3.0};
  recipe.layers = {boulders};
  EXPECT_DOUBLE_EQ(finest_size(recipe), 6.0);
  const Finish finish = finish_recipe(recipe, "r", {"ryugu", {}, 0.5});
  EXPECT_DOUBLE_EQ(finish.from, 6.0);
  EXPECT_EQ(finish.layers.front().layer, 1);
  EXPECT_DOUBLE_EQ(finish.layers.front().greatest, 6.0);
}

// What was measured is not finished again.
TEST(KnownPopulation, BeginsBelowTheHeightsOfARelief) {
  Recipe recipe = testing::sphere_recipe(0.25);
  recipe.length_unit = "km";
  recipe.layers = {testing::relief_layer(recipe, 0.004, -0.001, 0.001, [](const Vec3d&) { return 0.0; })};
  EXPECT_DOUBLE_EQ(finest_size(recipe), 0.004);
  const Finish finish = finish_recipe(recipe, "body.json", {"itokawa", {}, 0.001});
  EXPECT_LE(finish.layers.back().greatest, 0.004);
}

TEST(KnownPopulation, RefusesInOneLine) {
  using testing::has;
  EXPECT_TRUE(has(refusal(ball(1.0, "m"), {"vesta", {}, 0.1}), "no known body; name one of itokawa, bennu"));
  EXPECT_TRUE(has(refusal(ball(1.0, "px"), {"eros", {}, 0.1}), "r.json: length_unit: \"px\""));
  EXPECT_TRUE(has(refusal(ball(250.0, "m"), {"eros", 0.1, 0.5}), "which is not below"));
  EXPECT_TRUE(has(refusal(Recipe{}, {"eros", 0.5, 0.1}), "body: absent"));
}

// A patch of a body like Itokawa has as many boulders as the published law says.
TEST(KnownPopulation, PatchesHaveTheirBoulders) {
  const Finish finish = finish_recipe(ball(180.0, "m"), "r", {"itokawa", 4.0, 0.2});
  const Vec3d center = 180.0 * normalized(Vec3d{0.2, 0.9, -0.4});
  const ImplicitField field(finish.recipe, "r", PatchCube{center, 10.0});
  double inside = 0.0;
  for (const LayerBoulders& layer : field.boulders()) {
    for (const PlacedBoulder& b : layer.boulders) inside += norm(b.center - center) < 5.0;
  }
  const double expected = 78.54 * finish.layers.front().density;
  EXPECT_NEAR(inside, expected, 4.0 * std::sqrt(expected) + 0.03 * expected);
}

// Wright et al. 2016: a quarter dark, with means of Rayleigh's distributions, sqrt(pi / 2) times .030 and
// .168.
TEST(KnownAlbedo, DrawsAlbedosOfNearEarthAsteroids) {
  double dark = 0.0, sum = 0.0;
  constexpr int kDraws = 4000;
  for (std::uint64_t seed = 0; seed < kDraws; ++seed) {
    const KnownAlbedo drawn = drawn_albedo(seed);
    sum += drawn.ground.normal / kDraws;
    if (drawn.craters.fresh < 1.18) dark += 1.0 / kDraws;  // as Bennu's
  }
  EXPECT_NEAR(dark, 0.253, 0.02);
  EXPECT_NEAR(sum, 1.2533 * (0.253 * 0.030 + 0.747 * 0.168), 0.005);
}

TEST(KnownAlbedo, TakesThePlaceOfAnother) {
  Recipe recipe = testing::sphere_recipe(2.0);
  recipe.layers = {CraterLayer{}, BoulderLayer{}};
  for (const KnownAlbedo& known : known_albedos()) set_albedo(recipe, known);
  ASSERT_EQ(recipe.layers.size(), 3u);  // with one layer of mottles
  EXPECT_EQ(recipe.albedo->normal, 0.38);
  EXPECT_EQ(std::get<BoulderLayer>(recipe.layers[1]).albedo->normal, 0.38);
  EXPECT_EQ(std::get<FractalLayer>(recipe.layers[2]).use.combination.kind, Combine::kMask);
  validate_recipe(recipe, "r");
}

}  // namespace
}  // namespace astrolith
