#include "synthesis/finish/recipe_variation.h"

#include <cmath>

#include "geometry/mesh_topology.h"
#include "recipe/recipe_json.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/field/implicit_field.h"

namespace astrolith {
namespace {

// Forty spheres along a curve, and hills.
Recipe worm() {
  Recipe recipe;
  MetaballBody& body = recipe.body.emplace();
  body.blend_exponent = 3.0;
  for (int i = 0; i < 40; ++i) {
    const double t = 0.1 * i;
    body.spheres.push_back({{t, 0.4 * std::sin(t), 0.2 * std::cos(2 * t)}, 0.35 + 0.1 * std::sin(3 * t)});
  }
  FractalLayer hills;
  hills.amplitude = 0.02;
  hills.frequency = 5.0;
  recipe.layers.push_back(hills);
  return recipe;
}

TEST(RecipeVariation, IsValidAndDeterministic) {
  const Recipe recipe = worm();
  for (const double strength : {0.0, 0.3, 1.0}) {
    const Recipe varied = vary_recipe(recipe, strength, 7);
    EXPECT_NO_THROW(validate_recipe(varied, "varied"));
    EXPECT_EQ(recipe_to_json(varied), recipe_to_json(vary_recipe(recipe, strength, 7)));
    EXPECT_NE(recipe_to_json(varied), recipe_to_json(vary_recipe(recipe, strength, 8)));
    EXPECT_NE(varied.seed, recipe.seed);
  }
}

// A body made of two by an operation is deformed as a whole: the same as when one body holds all spheres.
TEST(RecipeVariation, OperandsMoveWithTheBody) {
  Recipe whole = worm(), combined = worm();
  whole.body->subtract = {whole.body->spheres[5]};
  BodyOperation operation;
  operation.operand.push_back(*combined.body);
  operation.operand[0].spheres.assign(whole.body->spheres.begin() + 20, whole.body->spheres.end());
  combined.body->spheres.resize(20);
  combined.body->operations.push_back(operation);
  const Recipe a = vary_recipe(whole, 0.5, 3), b = vary_recipe(combined, 0.5, 3);
  for (std::size_t i = 0; i < 40; ++i) {
    const Sphere &s = a.body->spheres[i],
                 &t = i < 20 ? b.body->spheres[i] : b.body->operations[0].operand[0].spheres[i - 20];
    EXPECT_EQ(s.center, t.center);
    EXPECT_EQ(s.radius, t.radius);
  }
  EXPECT_EQ(a.body->subtract[0].center, a.body->spheres[5].center) << "and so does what takes away";
  EXPECT_EQ(a.body->subtract[0].radius, a.body->spheres[5].radius);
}

TEST(RecipeVariation, WithoutStrengthOnlyTheNoiseIsNew) {
  const Recipe recipe = worm(), varied = vary_recipe(recipe, 0.0, 7);
  for (std::size_t i = 0; i < recipe.body->spheres.size(); ++i) {
    EXPECT_NEAR(norm(varied.body->spheres[i].center - recipe.body->spheres[i].center), 0.0, 1e-5);
    EXPECT_NEAR(varied.body->spheres[i].radius / recipe.body->spheres[i].radius, 1.0, 1e-4);
  }
  EXPECT_EQ(std::get<FractalLayer>(varied.layers[0]).amplitude, 0.02);
}

TEST(RecipeVariation, KeptNoiseIsThatOfTheOriginalOnAnotherBody) {
  const Recipe recipe = worm();
  const Recipe varied = vary_recipe(recipe, 0.5, 7, VariedNoise::kKept);
  EXPECT_EQ(varied.seed, recipe.seed);
  Recipe renewed = vary_recipe(recipe, 0.5, 7);
  EXPECT_NE(renewed.seed, recipe.seed);
  renewed.seed = recipe.seed;
  EXPECT_EQ(recipe_to_json(renewed), recipe_to_json(varied));
}

// Dust where the hills are low, joined to them: after a variation it lies where their heights are as low a
// share.
TEST(RecipeVariation, MasksAndJointsFollowTheHeights) {
  Recipe recipe = worm();
  std::get<FractalLayer>(recipe.layers[0]).name = "hills";
  FractalLayer dust = std::get<FractalLayer>(recipe.layers[0]);
  dust.name = "dust";
  dust.amplitude = 0.01;
  dust.use.mask = LayerMask{"hills", 0.005, -0.01};
  dust.use.combination.kind = Combine::kBlend;
  dust.use.combination.width = 0.002;
  recipe.layers.push_back(dust);
  const Recipe varied = vary_recipe(recipe, 0.8, 5);
  const auto& hills = std::get<FractalLayer>(varied.layers[0]);
  const auto& changed = std::get<FractalLayer>(varied.layers[1]);
  EXPECT_GT(std::fabs(hills.amplitude / 0.02 - 1.0), 0.01);
  EXPECT_NEAR(changed.use.mask->from / 0.005, hills.amplitude / 0.02, 1e-5);
  EXPECT_NEAR(changed.use.mask->to / -0.01, hills.amplitude / 0.02, 1e-5);
  EXPECT_NEAR(changed.use.combination.width / 0.002, changed.amplitude / 0.01, 1e-5);
}

TEST(RecipeVariation, WhatWasJoinedStaysJoined) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const ImplicitField field(vary_recipe(worm(), 0.6, seed));
    MeshCollector collector;
    mesh_field(field, field.bounds(), 64, collector);
    EXPECT_EQ(analyze_topology(collector.mesh).components, 1) << seed;
  }
}

}  // namespace
}  // namespace astrolith
