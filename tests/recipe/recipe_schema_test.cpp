// The reader and the schema, as another library understands it, accept and refuse equal documents.
#include "numerics/errors.h"
#include "recipe/recipe_json.h"
#include "tests/recipe/recipe_examples.h"
#include "tests/recipe/schema_validator.h"

namespace astrolith {
namespace {

class RecipeSchema : public ::testing::Test {
 protected:
  bool accepts(const std::string& text) const { return schema_.accepts(text); }

 private:
  const testing::SchemaValidator schema_{ASTROLITH_RECIPE_SCHEMA};
};

TEST_F(RecipeSchema, AcceptsWhatTheReaderAccepts) {
  EXPECT_TRUE(accepts(testing::kCompleteRecipe));
  EXPECT_TRUE(accepts(R"({"format_version": 1, "length_unit": "m",
                          "body": {"type": "metaballs", "spheres": [[0, 0, 0, 1]]}})"));
}

TEST_F(RecipeSchema, AcceptsWhatTheWriterWrites) {
  EXPECT_TRUE(accepts(recipe_to_json(parse_recipe(testing::kCompleteRecipe, "r"))));
  Recipe sphere;
  sphere.body.emplace().spheres.push_back({{1, 2, 3}, 4});
  EXPECT_TRUE(accepts(recipe_to_json(sphere)));
}

TEST_F(RecipeSchema, RejectsWhatTheReaderRejects) {
  for (const testing::Spoiled& change : testing::spoiled_recipes()) {
    const std::string text = testing::spoil(change);
    EXPECT_THROW(parse_recipe(text, "r"), InputError) << change.from << " -> " << change.to;
    EXPECT_NE(accepts(text), change.schema_can_tell) << change.from << " -> " << change.to;
  }
  EXPECT_FALSE(accepts(R"({"format_version": 1, "length_unit": "m"})"));
  EXPECT_FALSE(accepts(R"({"format_version": 1, "length_unit": "m", "layers": []})"));
}

}  // namespace
}  // namespace astrolith
