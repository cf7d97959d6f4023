#include "synthesis/finish/known_population.h"

#include <cmath>

#include "synthesis/field/implicit_field.h"
#include "synthesis/landforms/boulder_field.h"
#include "tests/synthesis/bodies.h"
#include "tests/synthesis/reliefs.h"

namespace astrolith {
namespace {

// A body of 500 m whose relief is rough where x > 0 and smooth elsewhere.
Recipe half_rough(double smooth) {
  constexpr double kSpacing = 8.0;
  Recipe recipe = testing::sphere_recipe(250.0);
  recipe.length_unit = "m";
  recipe.layers = {testing::relief_layer(recipe, kSpacing, -4.0, 4.0, [smooth](const Vec3d& p) {
    const double wave = std::sin(0.3 * p.x) * std::sin(0.31 * p.y) * std::sin(0.29 * p.z);
    return (p.x > 0.0 ? 4.0 : 4.0 * smooth) * wave;
  })};
  return recipe;
}

TEST(RoughGround, NeedsARelief) {
  Recipe recipe = testing::sphere_recipe(250.0);
  EXPECT_FALSE(rough_ground(recipe).has_value());
  Recipe flat = half_rough(0.0);
  flat.layers = {testing::relief_layer(flat, 8.0, -4.0, 4.0, [](const Vec3d&) { return 0.0; })};
  EXPECT_FALSE(rough_ground(flat).has_value());
}

TEST(RoughGround, HasTheDistanceOfTheHeights) {
  Recipe recipe = half_rough(1.0);
  const auto rough = rough_ground(recipe);
  ASSERT_TRUE(rough.has_value());
  EXPECT_EQ(std::get<ReliefLayer>(recipe.layers[0]).name, rough->mask.layer);
  EXPECT_EQ(rough->mask.over, 8.0);
  // A weight that is 1 on the roughest tenth alone and falls to 0 below a quarter of the median.
  EXPECT_GT(rough->mean_weight, 0.3);
  EXPECT_LT(rough->mean_weight, 0.7);
}

// Boulders of a finish lie on rough ground, as many on the body as the counts say.
TEST(RoughGround, BouldersSpareSmoothGround) {
  const Finish finish = finish_recipe(half_rough(0.05), "body", {"itokawa", 8.0, 2.0});
  const ImplicitField field(finish.recipe);
  double rough = 0.0, smooth = 0.0;
  for (const LayerBoulders& layer : field.boulders()) {
    for (const PlacedBoulder& boulder : layer.boulders) {
      (boulder.center.x > 10.0 ? rough : boulder.center.x < -10.0 ? smooth : rough) += 1.0;
    }
  }
  EXPECT_LT(smooth, 0.1 * rough);
  double expected = 0.0;
  for (const FinishLayer& layer : finish.layers) expected += layer.density * 4.0 * 3.14159265 * 250.0 * 250.0;
  EXPECT_NEAR(rough + smooth, expected, 0.05 * expected + 4.0 * std::sqrt(expected));
}

}  // namespace
}  // namespace astrolith
