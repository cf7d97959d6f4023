#include "estimation/shape/learning/surface_model.h"

#include <gtest/gtest.h>

#include "recipe/recipe_json.h"

namespace astrolith {
namespace {

SurfaceModel rubble() {
  SurfaceModel model;
  model.amplitude = 0.3;
  model.landforms = LandformKind::boulders;
  model.count = 200;
  model.exponent = 2.9;
  return model;
}

Recipe recipe_of(const SurfaceModel& model, double edge, const std::string& group) {
  Recipe recipe;
  recipe.body.emplace().spheres = {{{0, 0, 0}, 1.0}, {{1, 0, 0}, 0.5}};
  if (!group.empty()) recipe.body->groups.push_back({group, {0}});
  recipe.layers = layers_of(model, edge, group, edge);
  return recipe;
}

TEST(SurfaceModel, LayersAreThoseThatARecipeAccepts) {
  SurfaceModel craters = rubble();
  craters.landforms = LandformKind::craters;
  craters.shape = 0.1;
  for (const SurfaceModel& model : {rubble(), craters}) {
    for (const std::string group : {"", "imaged"}) {
      const Recipe recipe = recipe_of(model, 0.02, group);
      ASSERT_EQ(recipe.layers.size(), 3u);
      EXPECT_EQ(recipe_to_json(parse_recipe(recipe_to_json(recipe), "learnt")), recipe_to_json(recipe));
      EXPECT_EQ(population_of(recipe.layers[2])->locality.has_value(), !group.empty());
    }
  }
}

TEST(SurfaceModel, LengthsFollowTheEdge) {
  const Recipe small = recipe_of(rubble(), 0.01, ""), large = recipe_of(rubble(), 0.02, "");
  const auto& a = std::get<FractalLayer>(small.layers[1]);
  const auto& b = std::get<FractalLayer>(large.layers[1]);
  EXPECT_NEAR(b.amplitude / a.amplitude, 2.0, 1e-6);
  EXPECT_NEAR(a.frequency / b.frequency, 2.0, 1e-6);
  EXPECT_NEAR(b.use.mask->to / a.use.mask->to, 2.0, 1e-6);
  EXPECT_NEAR(population_of(large.layers[2])->least_diameter / population_of(small.layers[2])->least_diameter,
              2.0, 1e-6);
}

TEST(SurfaceModel, WithoutAmplitudeAndLandformsThereAreNoLayers) { EXPECT_TRUE(layers_of({}, 0.1).empty()); }

TEST(SurfaceModel, TheCentreOfTheSearchIsTheModelItself) {
  const SurfaceModel model = rubble();
  const SurfaceModel centre = model_at(model, std::vector<double>(searched_numbers(model.landforms), 0.0));
  EXPECT_DOUBLE_EQ(centre.amplitude, model.amplitude);
  EXPECT_DOUBLE_EQ(centre.count, model.count);
  EXPECT_DOUBLE_EQ(centre.exponent, model.exponent);
  EXPECT_DOUBLE_EQ(centre.shape, model.shape);
}

}  // namespace
}  // namespace astrolith
