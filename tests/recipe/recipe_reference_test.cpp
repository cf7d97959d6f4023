// docs/recipe.md keeps its word: its example is a recipe, and it describes every field of the schema.
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "recipe/recipe_json.h"

namespace astrolith {
namespace {

std::string text_of(const char* file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

std::string first_json_block(const std::string& markdown) {
  const std::string fence = "```json\n";
  const std::size_t begin = markdown.find(fence) + fence.size();
  return markdown.substr(begin, markdown.find("```", begin) - begin);
}

// Calls visit(name) for every property that the schema knows.
template <typename Visit>
void for_each_property(const nlohmann::json& schema, const Visit& visit) {
  if (!schema.is_structured()) return;
  for (const auto& [key, value] : schema.items()) {
    if (key == "properties") {
      for (const auto& property : value.items()) visit(property.key());
    }
    for_each_property(value, visit);
  }
}

TEST(RecipeReference, ExampleIsARecipe) {
  const Recipe recipe = parse_recipe(first_json_block(text_of(ASTROLITH_RECIPE_REFERENCE)), "docs/recipe.md");
  ASSERT_TRUE(recipe.body.has_value());
  EXPECT_EQ(recipe.body->spheres.size(), 2u);
  EXPECT_GE(recipe.layers.size(), 5u);
}

TEST(RecipeReference, ExampleHasEveryField) {
  // The writer writes all fields: so must the example hold them, in the writer's order.
  const std::string example = first_json_block(text_of(ASTROLITH_RECIPE_REFERENCE));
  EXPECT_EQ(recipe_to_json(parse_recipe(example, "docs/recipe.md")), example);
}

TEST(RecipeReference, EveryFieldIsDescribed) {
  const std::string reference = text_of(ASTROLITH_RECIPE_REFERENCE);
  int fields = 0;
  for_each_property(nlohmann::json::parse(text_of(ASTROLITH_RECIPE_SCHEMA)), [&](const std::string& name) {
    ++fields;
    const bool described = reference.find("`" + name + "`") != std::string::npos ||
                           reference.find("`\"" + name + "\"") != std::string::npos;
    EXPECT_TRUE(described || name == "type") << name;
  });
  EXPECT_GT(fields, 30);
}

}  // namespace
}  // namespace astrolith
