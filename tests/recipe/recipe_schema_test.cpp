// The schema, read by another library, and the reader agree on what a recipe is.
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "numerics/errors.h"
#include "recipe/recipe_json.h"
#include "tests/recipe/recipe_examples.h"

namespace astrolith {
namespace {

using valijson::adapters::NlohmannJsonAdapter;

class RecipeSchema : public ::testing::Test {
 protected:
  RecipeSchema() {
    const nlohmann::json document = nlohmann::json::parse(std::ifstream(ASTROLITH_RECIPE_SCHEMA));
    valijson::SchemaParser(valijson::SchemaParser::kDraft7)
        .populateSchema(NlohmannJsonAdapter(document), schema_);
  }
  bool accepts(const std::string& text) {
    const nlohmann::json document = nlohmann::json::parse(text);
    return valijson::Validator().validate(schema_, NlohmannJsonAdapter(document), nullptr);
  }

 private:
  valijson::Schema schema_;
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
