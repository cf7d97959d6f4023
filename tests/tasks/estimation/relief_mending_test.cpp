#include "tasks/estimation/relief_mending.h"

#include <cmath>

#include "estimation/shape/details/details_fit.h"
#include "estimation/shape/target/surface_components.h"
#include "recipe/recipe_json.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/field/implicit_field.h"
#include "tests/synthesis/reliefs.h"

namespace astrolith {
namespace {

constexpr int kCells = 48;

// Two bodies with a gap between them, which a relief fills.
struct Bridged {
  Recipe recipe;
  TargetBody target;
  ShapeFitOptions options;
  ShapeFitResult fit;

  Bridged()
      : recipe(pair()), target(prepare_target(make_coarse_mesh(ImplicitField(recipe), kCells), "pair")) {
    recipe.layers = {testing::relief_layer(recipe, 0.1, 0.0, 0.4,
                                           [](const Vec3d& p) { return std::fabs(p.x) < 0.5 ? 0.3 : 0.0; })};
    options.check_resolution = kCells;
    options.check_samples = 2000;
    fit.check = check_recipe(target, recipe, kCells, options.check_samples, 1);
  }
  static Recipe pair() {
    Recipe recipe;
    recipe.body = MetaballBody{};
    recipe.body->blend_exponent = 6.0;
    recipe.body->spheres = {{{-1.2, 0, 0}, 1.0}, {{1.2, 0, 0}, 1.0}};
    return recipe;
  }
};

// As if the heights had joined the bodies, which these do not quite.
TEST(ReliefMending, TakesBackHeightsWhereTheFitIsJoined) {
  Bridged body;
  ASSERT_EQ(parts_and_handles(body.target).words(), "2 parts and 0 handles");
  const double before = body.fit.check.distance.max;
  body.fit.check.topology.components = 1;
  EXPECT_GT(mend_relief(body.target, body.options, 0, {}, body.recipe, body.fit), 0u);
  EXPECT_EQ(parts_and_handles(body.fit.check.topology), parts_and_handles(body.target));
  EXPECT_LT(body.fit.check.distance.max, 0.75 * before);
  // What was measured is that of the recipe.
  const FitCheck again = check_recipe(body.target, body.recipe, kCells, 2000, 1);
  EXPECT_EQ(parts_and_handles(again.topology), parts_and_handles(body.target));
}

TEST(ReliefMending, KeepsWithinTheBytes) {
  Bridged body;
  body.fit.check.topology.components = 1;
  const Recipe before = body.recipe;
  EXPECT_EQ(mend_relief(body.target, body.options, 1, {}, body.recipe, body.fit), 0u);
  EXPECT_EQ(recipe_to_json(body.recipe), recipe_to_json(before));
}

TEST(ReliefMending, LeavesAFitOfTheRightTopologyAlone) {
  Bridged body;
  body.recipe.layers.clear();
  body.fit.check = check_recipe(body.target, body.recipe, kCells, 2000, 1);
  EXPECT_EQ(mend_relief(body.target, body.options, 0, {}, body.recipe, body.fit), 0u);
}

}  // namespace
}  // namespace astrolith
