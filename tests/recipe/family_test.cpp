#include "recipe/family.h"

#include <tuple>

#include "numerics/errors.h"
#include "recipe/recipe_json.h"
#include "tests/support/refusal.h"

namespace astrolith {
namespace {

const std::string kBall = R"({"format_version": 1, "length_unit": "m", "seed": 3,
  "body": {"type": "metaballs", "spheres": [[0, 0, 0, 100], [50, 0, 0, 60]]},
  "layers": [{"type": "simplex", "amplitude": 1, "frequency": 0.01, "octaves": 2},
             {"type": "craters", "population": {"count": 5, "least_diameter": 5, "greatest_diameter": 50}}],
  "family": )";

Recipe recipe_with(const std::string& family) { return parse_recipe(kBall + family + "}", "f.json"); }

std::string refusal_of(const std::string& family) {
  return testing::refusal_of([&] { recipe_with(family); });
}

TEST(Family, IsReadAndWrittenAlike) {
  const Recipe recipe = recipe_with(R"({"any_sun": true, "fields": [
    {"field": "layers[0].amplitude", "distribution": "log_uniform", "low": 0.5, "high": 2},
    {"field": "body.spheres[1].radius", "distribution": "normal", "mean": 60, "deviation": 5, "low": 50, "high": 70},
    {"field": "layers[1].population.count", "distribution": "integer", "low": 0, "high": 9},
    {"field": "layers[0].octaves", "distribution": "choice", "values": [1, 3]}]})");
  ASSERT_EQ(recipe.family->fields.size(), 4u);
  EXPECT_EQ(recipe.family->fields[1].distribution, Distribution::kNormal);
  EXPECT_EQ(recipe.family->fields[1].mean, 60.0);
  EXPECT_TRUE(recipe.family->any_sun);
  EXPECT_FALSE(recipe.family->any_view);
  const std::string text = recipe_to_json(recipe);
  EXPECT_EQ(recipe_to_json(parse_recipe(text, "again")), text);
  EXPECT_EQ(recipe_to_json(parse_recipe(recipe_to_compact(recipe), "compact")), text);
}

TEST(Family, SetsNumbersByTheirPaths) {
  Recipe recipe = recipe_with("{}");
  EXPECT_EQ(
      set_numbers(recipe, {"body.spheres[1].x", "seed", "layers[1].population.count"}, {7.5, 11.0, 8.0}), -1);
  EXPECT_EQ(recipe.body->spheres[1].center.x, 7.5);
  EXPECT_EQ(recipe.body->spheres[0].center.x, 0.0);
  EXPECT_EQ(recipe.seed, 11u);
  EXPECT_EQ(std::get<CraterLayer>(recipe.layers[1]).population->drawn.count, 8);
  for (const char* wrong :
       {"layers[2].amplitude", "layers[01].amplitude", "layers[0]", "layers[0].", "amplitude", "",
        "body.spheres[1]", "erosion.talus_angle", "length_unit", "layers[0].amplitude.x", "]", "["}) {
    EXPECT_EQ(set_numbers(recipe, {"seed", wrong}, {1.0, 2.0}), 1) << wrong;
  }
}

TEST(Family, RefusesWhatNoMemberCouldBe) {
  for (const auto& [field, rest, words] : {
           std::tuple{"layers[0].amplitud", R"("low": 1, "high": 2)", "fields[0].field: names no number"},
           {"format_version", R"("distribution": "integer", "low": 1, "high": 1)",
            "fields[0].field: names no"},
           {"layers[0].amplitude", R"("low": 2, "high": 1)", "fields[0].high: must be at least low"},
           {"layers[0].amplitude", R"("low": 2)", "fields[0].high: is missing; \"uniform\" needs it"},
           {"layers[0].amplitude", R"("low": 1, "high": 2, "mean": 1)", "fields[0].mean: has no meaning"},
           {"layers[0].amplitude", R"("distribution": "choice")", "fields[0].values: is missing"},
           {"layers[0].amplitude", R"("distribution": "log_uniform", "low": 0, "high": 2)",
            "fields[0].low: must be above 0"},
           {"layers[0].amplitude", R"("distribution": "integer", "low": 0.5, "high": 2)",
            "fields[0]: low and high must be whole"},
           {"layers[0].amplitude",
            R"("distribution": "normal", "mean": 0, "deviation": 1, "low": 5, "high": 9)",
            "fields[0]: low to high must be at least a tenth of the deviation wide"},
           {"layers[0].octaves", R"("low": 1, "high": 2.5)", "fields[0].distribution: must be \"integer\""},
           {"layers[0].octaves", R"("distribution": "integer", "low": 1, "high": 99)",
            " with the greatest numbers, layers[0].octaves: must be"},
           {"layers[0].frequency", R"("low": -1, "high": 1)",
            " with the least numbers, layers[0].frequency: must be above 0"},
       }) {
    const std::string text = std::string(R"({"fields": [{"field": ")") + field + "\", " + rest + "}]}";
    const std::string refusal = refusal_of(text);
    EXPECT_TRUE(testing::has(refusal, std::string("f.json: family") + (*words == ' ' ? ":" : ".") + words));
  }
  EXPECT_TRUE(testing::has(
      refusal_of(R"({"fields": [{"field": "seed", "low": 1, "high": 2, "distribution": "integer"},
                                {"field": "seed", "low": 1, "high": 2, "distribution": "integer"}]})"),
      "f.json: family.fields[1].field: is drawn twice: \"seed\""));
}

}  // namespace
}  // namespace astrolith
