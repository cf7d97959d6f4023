#include "synthesis/field/feature_list.h"

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/scratch_folder.h"
#include "tests/synthesis/bodies.h"

namespace astrolith {
namespace {

// A ball of radius 10 with hills, a crater at its pole and a boulder on the axis of x.
Recipe cratered_ball() {
  Recipe recipe = testing::sphere_recipe(10.0);
  recipe.frame = "\"own\"";
  CraterLayer craters;
  craters.craters.resize(1);
  craters.craters[0].place = {{0, 0, 1}, true};
  craters.craters[0].diameter = 4.0;
  BoulderLayer boulders;
  boulders.boulders.resize(1);
  boulders.boulders[0].place = {{1, 0, 0}, true};
  boulders.boulders[0].axes = {2.0, 1.5, 1.0};
  recipe.layers = {testing::fractal_layer(0.2, 5.0, 3), craters, boulders};
  return recipe;
}

nlohmann::json listed(const Recipe& recipe, const std::optional<PatchCube>& patch) {
  const testing::ScratchFolder folder;
  write_feature_list(ImplicitField(recipe, "recipe", patch), recipe, patch, 0.7, folder / "list.json");
  std::ifstream file(folder / "list.json");
  return nlohmann::json::parse(file);
}

Vec3d point(const nlohmann::json& feature, const std::string& prefix) {
  return {feature[prefix + "x"], feature[prefix + "y"], feature[prefix + "z"]};
}

TEST(FeatureList, PlacesLieOnTheFinishedSurface) {
  const Recipe recipe = cratered_ball();
  const ImplicitField field(recipe);
  const nlohmann::json list = listed(recipe, {});
  EXPECT_EQ(list["frame"], "\"own\"");
  ASSERT_EQ(list["features"].size(), 2u);
  for (const auto& feature : list["features"]) {
    EXPECT_NEAR(field.value(point(feature, "")), 0.0, 1e-4) << feature;
    EXPECT_EQ(point(feature, ""), point(feature, "mesh_"));
  }
  const Vec3d crater = point(list["features"][0], ""), boulder = point(list["features"][1], "");
  EXPECT_NEAR(std::hypot(crater.x, crater.y), 0.0, 1e-3) << "on the normal through its centre";
  EXPECT_LT(crater.z, point(list["features"][0], "center_").z) << "its floor lies below the bare surface";
  EXPECT_GT(norm(boulder), norm(point(list["features"][1], "center_"))) << "its top, not its own centre";
}

// The crater is 4 wide and .544 deep with its rim; the boulder is 1.5 across and stands .7 above the ground.
TEST(FeatureList, WhatTheMeshDoesNotShowIsNotResolved) {
  const Recipe recipe = cratered_ball();
  const ImplicitField field(recipe);
  const std::vector<Feature> both = list_features(field, {});
  EXPECT_TRUE(is_resolved(both[0], 2.0));
  EXPECT_FALSE(is_resolved(both[0], 2.01)) << "fewer than two cells across";
  EXPECT_TRUE(is_resolved(both[1], 0.75));
  EXPECT_FALSE(is_resolved(both[1], 0.76));
  PlacedCrater flat = *both[0].crater;
  flat.depth = 0.05, flat.rim_height = 0.0;
  EXPECT_TRUE(is_resolved({1, &flat, nullptr}, 0.49));
  EXPECT_FALSE(is_resolved({1, &flat, nullptr}, 0.51)) << "shallower than a tenth of a cell";
  EXPECT_TRUE(listed(recipe, {})["features"][0]["resolved"]);
  const Vec3d floor = point(listed(recipe, {})["features"][0], "");
  EXPECT_EQ(FeatureFinder(field, recipe, {}, 0.7).row_at(floor, 0.0f), 0);
  EXPECT_EQ(FeatureFinder(field, recipe, {}, 2.01).row_at(floor, 0.0f), -1);
}

// A boulder of a patch is looked for in the coordinates of the patch: its top is its own, to the digits of
// the size of the boulder, where float coordinates of the body are ten times as coarse.
TEST(FeatureList, FineBouldersOfAPatchAreFound) {
  Recipe recipe = testing::sphere_recipe(1e4);
  BoulderLayer boulders;
  boulders.boulders.resize(1);
  boulders.boulders[0].place = {{1, 2, 3}, true};
  boulders.boulders[0].axes = {1e-4, 1e-4, 1e-4};
  boulders.roughness = boulders.smoothing = boulders.angularity = 0.0;
  recipe.layers = {boulders};
  const PatchCube cube{1e4 * normalized(Vec3d{1, 2, 3}), 4e-3};
  const ImplicitField field(recipe, "recipe", cube);
  const FeatureFinder landforms(field, recipe, cube, 1e-6);
  const PlacedBoulder& rock = field.boulders()[0].boulders[0];
  const Vec3d up = normalized(rock.center);
  EXPECT_EQ(landforms.row_at(rock.center + 0.49e-4 * up, 0.0f), 0);
  EXPECT_EQ(landforms.row_at(rock.center + 0.51e-4 * up, 0.0f), -1);
}

// The second lies in the first.
TEST(FeatureList, HiddenBouldersAreNotResolved) {
  Recipe recipe = testing::sphere_recipe(10.0);
  BoulderLayer boulders;
  for (const double side : {4.0, 1.5, 1.6}) {
    boulders.boulders.push_back({});
    boulders.boulders.back().place = {{side == 1.6 ? -1.0 : 1.0, 0, 0}, true};
    boulders.boulders.back().axes = {side, side, side};
  }
  boulders.roughness = boulders.smoothing = boulders.angularity = 0.0;
  recipe.layers = {boulders};
  std::vector<bool> resolved;
  const nlohmann::json list = listed(recipe, {});
  for (const auto& feature : list["features"]) resolved.push_back(feature["resolved"]);
  EXPECT_EQ(resolved, (std::vector<bool>{true, false, true}));
}

TEST(FeatureList, APatchHasItsOwnInItsFrame) {
  const Recipe recipe = cratered_ball();
  const PatchCube cube{{0, 0, 10}, 3};
  const nlohmann::json list = listed(recipe, cube);
  ASSERT_EQ(list["features"].size(), 1u) << "the boulder is not in the patch";
  const auto& crater = list["features"][0];
  EXPECT_EQ(list["origin"], (std::vector<double>{0, 0, 10}));
  EXPECT_NEAR(norm(point(crater, "") - point(crater, "mesh_") - cube.center), 0.0, 1e-12);
  EXPECT_TRUE(listed(recipe, PatchCube{{0, -10, 0}, 3})["features"].empty());
}

TEST(SurfaceCrossing, IsTheNearestOfABall) {
  const ImplicitField field(testing::sphere_recipe(10.0));
  const auto near = nearest_crossing(field, {0, 0, 3}, {0, 0, 1}, 14);
  ASSERT_TRUE(near.has_value());
  EXPECT_NEAR(near->z, 10.0, 1e-3);
  EXPECT_FALSE(nearest_crossing(field, {0, 0, 3}, {0, 0, 1}, 2).has_value());
}

}  // namespace
}  // namespace astrolith
