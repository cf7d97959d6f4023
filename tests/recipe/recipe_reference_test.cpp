// The example in docs/recipe.md is a recipe, and the schema's defaults are the reader's. Another test
// compares the document's tables with the schema (scripts/recipe_reference.py).
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

nlohmann::json schema() { return nlohmann::json::parse(text_of(ASTROLITH_RECIPE_SCHEMA)); }

// A layer of this type with no field beyond the required ones.
nlohmann::json least_layer(const std::string& type) {
  nlohmann::json layer = {{"type", type}};
  if (type == "gabor") layer["lobes"] = {{4, 0.1, 0.0, 1.0}};
  if (type == "relief") layer.update({{"spacing", 1}, {"low", 0}, {"high", 1}, {"levels", 2}});
  if (type == "exemplar" || type == "relief") {
    layer["image"] = "photo.png";
    layer["image_sha256"] = std::string(64, '0');
  }
  return layer;
}

// Expects that the writer wrote each default that a definition states. Returns the number of defaults
// compared.
int expect_defaults(const nlohmann::json& definition, const nlohmann::json& written) {
  int compared = 0;
  for (const auto& [name, field] : definition.at("properties").items()) {
    if (!field.contains("default") || !written.contains(name)) continue;
    EXPECT_EQ(written.at(name), field.at("default")) << written.value("type", "") << '.' << name;
    ++compared;
  }
  return compared;
}

TEST(RecipeReference, ExampleIsARecipe) {
  const Recipe recipe = parse_recipe(first_json_block(text_of(ASTROLITH_RECIPE_REFERENCE)), "docs/recipe.md");
  ASSERT_TRUE(recipe.body.has_value());
  EXPECT_EQ(recipe.body->spheres.size(), 2u);
  EXPECT_GE(recipe.layers.size(), 5u);
}

TEST(RecipeReference, ExampleHasEveryField) {
  // The writer writes all fields, so the example must hold all fields in the writer's order.
  const std::string example = first_json_block(text_of(ASTROLITH_RECIPE_REFERENCE));
  EXPECT_EQ(recipe_to_json(parse_recipe(example, "docs/recipe.md")), example);
}

TEST(RecipeReference, DefaultsAreTheReaders) {
  const nlohmann::json document = schema(), &definitions = document.at("definitions");
  nlohmann::json recipe = {{"format_version", 1},
                           {"length_unit", "m"},
                           {"body", {{"type", "metaballs"}, {"spheres", {{0, 0, 0, 1}}}}},
                           {"erosion", {{"talus_angle", 30}}}};
  std::vector<const nlohmann::json*> owners;
  for (const auto& item : document.at("properties").at("layers").at("items").at("oneOf")) {
    const std::string reference = item.at("$ref");
    const nlohmann::json& owner = definitions.at(reference.substr(reference.rfind('/') + 1));
    for (const auto& type : owner.at("properties").at("type").at("enum")) {
      recipe["layers"].push_back(least_layer(type));
      owners.push_back(&owner);
    }
  }
  const nlohmann::json written = nlohmann::json::parse(recipe_to_json(parse_recipe(recipe.dump(), "test")));
  int compared = expect_defaults(document, written) +
                 expect_defaults(definitions.at("metaballs"), written.at("body")) +
                 expect_defaults(definitions.at("erosion"), written.at("erosion"));
  for (std::size_t i = 0; i < owners.size(); ++i) {
    compared += expect_defaults(*owners[i], written.at("layers").at(i));
  }
  EXPECT_GT(compared, 80);
}

}  // namespace
}  // namespace astrolith
