#include "tasks/estimation/relief_size.h"

#include "numerics/errors.h"
#include "recipe/recipe_json.h"
#include "synthesis/field/field_mesh.h"
#include "tests/synthesis/bodies.h"

namespace astrolith {
namespace {

std::string complaint(const std::string& words) { return relief_spacing_words().complaint(words); }

TEST(ReliefSize, SpacingsAreInTheUnitThatTheyState) {
  EXPECT_EQ(parse_relief_spacing("auto", "km", 0.25), 0.0);
  EXPECT_EQ(parse_relief_spacing("2.5", "km", 0.25), 2.5);
  EXPECT_EQ(parse_relief_spacing("50m", "km", 0.25), 0.05);
  EXPECT_EQ(parse_relief_spacing("0.5 km", "m", 0.25), 500.0);
  EXPECT_EQ(parse_relief_spacing("3edges", "km", 0.25), 0.75);
  for (const char* words : {"auto", "1", "1e-3", "2 edges", "7m"}) EXPECT_EQ(complaint(words), "") << words;
  for (const char* words : {"", "0", "-1m", "nan", "inf", "1e999", "edges", "3 feet", "2  m", "1m "}) {
    EXPECT_NE(complaint(words), "") << words;
  }
}

// A potato with bumps as a target, and the recipe of the potato alone.
struct BumpyTarget {
  Recipe bare = testing::potato_recipe(40, 9);
  TargetBody target = prepare_target(bumpy_mesh(), "bumpy");

 private:
  TriangleMesh bumpy_mesh() const {
    Recipe bumpy = bare;
    bumpy.layers = {testing::fractal_layer(0.02, 4.0, 2)};
    return make_coarse_mesh(ImplicitField(bumpy), 60);
  }
};

TEST(ReliefSize, HeightsFillTheBytes) {
  const BumpyTarget bumpy;
  double last = 1e9;
  for (const std::size_t more : {500u, 2000u}) {
    Recipe recipe = bumpy.bare;
    const std::size_t bytes = recipe_to_compact(recipe).size() + more;
    const ReliefFit relief = add_relief_within(bumpy.target, bytes, {}, recipe);
    const std::size_t size = recipe_to_compact(recipe).size();
    EXPECT_LE(size, bytes);
    EXPECT_GT(size, bytes - more / 10);
    EXPECT_LT(relief.residual, 0.7 * last);
    last = relief.residual;
  }
}

TEST(ReliefSize, TakesNoMoreBytesThanTheModelGivesReasonFor) {
  const BumpyTarget bumpy;
  Recipe small_recipe = bumpy.bare, model_recipe = bumpy.bare;
  add_relief_within(bumpy.target, 1000000, {}, small_recipe);
  add_relief(bumpy.target, "auto", {}, model_recipe);
  EXPECT_EQ(recipe_to_compact(small_recipe), recipe_to_compact(model_recipe));
}

TEST(ReliefSize, BytesThatLeaveNoRoomAreRefused) {
  const BumpyTarget bumpy;
  Recipe recipe = bumpy.bare;
  EXPECT_THROW(add_relief_within(bumpy.target, recipe_to_compact(recipe).size() + 60, {}, recipe),
               InputError);
  EXPECT_THROW(add_relief_within(bumpy.target, 10, {}, recipe), InputError);
  EXPECT_TRUE(recipe.layers.empty());
}

}  // namespace
}  // namespace astrolith
