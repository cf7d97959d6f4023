#include "synthesis/field/landform_list.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "synthesis/field/surface_crossing.h"
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
  write_landform_list(ImplicitField(recipe, "recipe", patch), recipe, patch, folder / "list.json");
  std::ifstream file(folder / "list.json");
  return nlohmann::json::parse(file);
}

Vec3d point(const nlohmann::json& feature, const std::string& prefix) {
  return {feature[prefix + "x"], feature[prefix + "y"], feature[prefix + "z"]};
}

TEST(LandformList, PlacesLieOnTheFinishedSurface) {
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

TEST(LandformList, APatchHasItsOwnInItsFrame) {
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
