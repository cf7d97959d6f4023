// The reader and the schema, as another library understands it, accept and refuse equal documents.
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "numerics/errors.h"
#include "recipe/fields_internal.h"
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

// The schema and the lists of fields agree: they have equal fields, requirements and limits.

using nlohmann::json;

struct Field {
  int structs_that_require_it = 0;
  bool required = false;                    // by all structs of the definition
  std::optional<NumberLimits> limits = {};  // limits of a number, or of each number in a row
};
using Fields = std::map<std::string, Field>;

// Collects the fields of structs, but not the fields of structs within them.
class FieldLister final : public FieldVisitor {
 public:
  explicit FieldLister(const Place& root) : FieldVisitor(Task::kDescribe, root) {}

  Fields fields;

 private:
  void visit_number(double&, const NumberLimits& limits) override { current_->limits = limits; }
  void visit_integer(int&, const IntegerLimits& limits) override {
    current_->limits = range(static_cast<double>(limits.low), static_cast<double>(limits.high));
  }
  bool enter(std::string_view name, bool required, bool) override {
    if (depth_ > 1) return false;
    current_ = &fields[std::string(name)];
    current_->structs_that_require_it += required;
    return true;
  }
  void begin_object() override { ++depth_; }
  void end_object() override { --depth_; }
  std::size_t begin_array(std::size_t size, std::span<const std::string_view> names, bool) override {
    return names.empty() ? 0 : size;
  }

  int depth_ = 0;
  Field* current_ = nullptr;
};

// The fields of all structs that one definition of the schema describes.
template <class... T>
Fields list_fields(T... structs) {
  const std::string name = "recipe";
  const Place root(name);
  FieldLister lister(root);
  (lister.visit(structs), ...);
  for (auto& [field, facts] : lister.fields) {
    facts.required = facts.structs_that_require_it == static_cast<int>(sizeof...(structs));
  }
  return lister.fields;
}

Layer fractal(Noise noise) {
  FractalLayer layer;
  layer.noise = noise;
  return layer;
}

MetaballBody morph() {
  MetaballBody body;
  body.morph.emplace();
  return body;
}

Donor donor() {
  Donor donor;
  donor.body.emplace_back();
  return donor;
}

MeasuredBody measured_body() {
  MeasuredBody body;
  body.body.emplace_back();
  return body;
}

BodyOperation operation(Operator kind) {
  BodyOperation operation;
  operation.kind = kind;
  operation.operand.emplace_back();
  return operation;
}

Combination combination(Combine kind) {
  Combination combination;
  combination.kind = kind;
  return combination;
}

// The fields of all structs, by the name of their definition in the schema.
std::map<std::string, Fields> described() {
  return {{"document", list_fields(Recipe{})},
          {"provenance", list_fields(Provenance{})},
          {"ground_albedo", list_fields(GroundAlbedo{})},
          {"albedo_by_elevation", list_fields(AlbedoByElevation{})},
          {"layer_albedo", list_fields(LayerAlbedo{})},
          {"crater_albedo", list_fields(CraterAlbedo{})},
          {"boulder_albedo", list_fields(BoulderAlbedo{})},
          {"erosion", list_fields(Erosion{})},
          {"family", list_fields(Family{})},
          {"drawn_field", list_fields(DrawnField{})},
          {"metaballs", list_fields(MetaballBody{})},
          {"morph", list_fields(morph())},
          {"donor", list_fields(donor())},
          {"population", list_fields(BodyPopulation{})},
          {"draw", list_fields(DrawConditions{})},
          {"measured_body", list_fields(measured_body())},
          {"r_function", list_fields(operation(Operator::kUnion))},
          {"blend", list_fields(operation(Operator::kBlend))},
          {"clean_union", list_fields(operation(Operator::kCleanUnion))},
          {"warp", list_fields(Warp{})},
          {"locality", list_fields(Locality{})},
          {"mask", list_fields(LayerMask{})},
          {"combine", list_fields(combination(Combine::kAdd), combination(Combine::kBlend),
                                  combination(Combine::kWarp))},
          {"gradient_noise", list_fields(fractal(Noise::kSimplex))},
          {"worley", list_fields(fractal(Noise::kWorleyF1))},
          {"spots", list_fields(Layer{SpotLayer{}})},
          {"spot_part", list_fields(SpotPart{})},
          {"sparse", list_fields(Layer{SparseLayer{}})},
          {"random_phase", list_fields(Layer{RandomPhaseLayer{}})},
          {"phasor", list_fields(Layer{PhasorLayer{}})},
          {"gabor", list_fields(Layer{GaborLayer{}})},
          {"exemplar", list_fields(Layer{ExemplarLayer{}})},
          {"relief", list_fields(Layer{ReliefLayer{}})},
          {"color", list_fields(LayerColor{})},
          {"craters", list_fields(Layer{CraterLayer{}})},
          {"crater_profile", list_fields(CraterProfile{})},
          {"crater", list_fields(Crater{})},
          {"weibull_sizes", list_fields(WeibullSizes{})},
          {"clusters", list_fields(Clusters{})},
          {"crater_population", list_fields(CraterPopulation{})},
          {"boulders", list_fields(Layer{BoulderLayer{}})},
          {"boulder", list_fields(Boulder{})},
          {"boulder_population", list_fields(BoulderPopulation{})},
          {"local_gravity", list_fields(LocalGravity{})}};
}

class RecipeFields : public ::testing::Test {
 protected:
  RecipeFields() : schema_(json::parse(std::ifstream(ASTROLITH_RECIPE_SCHEMA))) {
    definitions_ = schema_.at("definitions");
    definitions_["document"] = schema_;
  }

  // The schema's rules for a number, or for each number in an array.
  json number_rules(const json& field) const {
    if (field.contains("$ref")) {
      const std::string reference = field.at("$ref");
      return number_rules(definitions_.at(reference.substr(reference.rfind('/') + 1)));
    }
    return field.contains("items") && field.at("items").is_object() ? number_rules(field.at("items")) : field;
  }

  json schema_, definitions_;
};

template <class Map>
std::vector<std::string> keys(const Map& map) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : map) keys.push_back(key);
  return keys;
}

TEST_F(RecipeFields, SchemaHasTheSameFields) {
  std::map<std::string, Fields> structs = described();
  for (const auto& [name, definition] : definitions_.items()) {
    if (!definition.contains("properties")) continue;
    ASSERT_TRUE(structs.contains(name)) << name;
    const auto properties = definition.at("properties").get<std::map<std::string, json>>();
    EXPECT_EQ(keys(structs.at(name)), keys(properties)) << name;
    structs.erase(name);
  }
  EXPECT_TRUE(structs.empty()) << structs.begin()->first;
}

TEST_F(RecipeFields, SchemaRequiresTheSameFields) {
  for (const auto& [name, fields] : described()) {
    const std::vector<std::string> required =
        definitions_.at(name).value("required", std::vector<std::string>());
    for (const auto& [field, facts] : fields) {
      EXPECT_EQ(facts.required, std::count(required.begin(), required.end(), field) == 1)
          << name << '.' << field;
    }
  }
}

TEST_F(RecipeFields, SchemaStatesTheSameLimits) {
  // These limits depend on other fields, and the schema states them in part.
  const std::vector<std::string> by_rule = {"crater.depth", "crater.rim_height", "erosion.rotation_period",
                                            "local_gravity.rotation_period", "spots.density"};
  int compared = 0;
  for (const auto& [name, fields] : described()) {
    for (const auto& [field, facts] : fields) {
      const std::string path = name + '.' + field;
      if (!facts.limits || std::count(by_rule.begin(), by_rule.end(), path) == 1) continue;
      const json rules = number_rules(definitions_.at(name).at("properties").at(field));
      const char* const low = facts.limits->low_is_allowed ? "minimum" : "exclusiveMinimum";
      EXPECT_EQ(rules.value(low, -HUGE_VAL), facts.limits->low) << path;
      EXPECT_EQ(rules.value("maximum", HUGE_VAL), facts.limits->high) << path;
      ++compared;
    }
  }
  EXPECT_GT(compared, 100);
}

// The examples in docs/ are recipes, and the schema's defaults are the reader's. Another test compares
// the document's tables with the schema (scripts/docs.py).

std::string read_schema_text(const char* file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

std::string first_json_block(const std::string& markdown) {
  const std::string fence = "```json\n";
  const std::size_t begin = markdown.find(fence) + fence.size();
  return markdown.substr(begin, markdown.find("```", begin) - begin);
}

nlohmann::json schema() { return nlohmann::json::parse(read_schema_text(ASTROLITH_RECIPE_SCHEMA)); }

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

TEST(RecipeReference, ExamplesAreRecipes) {
  const std::string docs = ASTROLITH_RECIPE_REFERENCE;
  const Recipe short_one =
      parse_recipe(first_json_block(read_schema_text((docs + "/recipe.md").c_str())), "docs/recipe.md");
  ASSERT_TRUE(short_one.body.has_value());
  EXPECT_EQ(short_one.layers.size(), 1u);
  const Recipe recipe =
      parse_recipe(read_schema_text((docs + "/recipe_example.json").c_str()), "recipe_example.json");
  ASSERT_TRUE(recipe.body.has_value());
  EXPECT_EQ(recipe.body->spheres.size(), 2u);
  EXPECT_GE(recipe.layers.size(), 5u);
}

TEST(RecipeReference, ExampleHasEveryField) {
  // The writer writes all fields, so the example must hold all fields in the writer's order.
  const std::string example = read_schema_text(ASTROLITH_RECIPE_REFERENCE "/recipe_example.json");
  EXPECT_EQ(recipe_to_json(parse_recipe(example, "recipe_example.json")), example);
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
