#include <tuple>
#include <type_traits>

#include "numerics/errors.h"
#include "recipe/family.h"
#include "recipe/recipe.h"
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

std::string refusal_text(const std::string& family) {
  return testing::refusal_text([&] { recipe_with(family); });
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
    const std::string refusal = refusal_text(text);
    EXPECT_TRUE(testing::has(refusal, std::string("f.json: family") + (*words == ' ' ? ":" : ".") + words));
  }
  EXPECT_TRUE(testing::has(
      refusal_text(R"({"fields": [{"field": "seed", "low": 1, "high": 2, "distribution": "integer"},
                                {"field": "seed", "low": 1, "high": 2, "distribution": "integer"}]})"),
      "f.json: family.fields[1].field: is drawn twice: \"seed\""));
}

// No trait has a default, so that a kind that forgets one does not compile.
static_assert(!std::is_default_constructible_v<LayerTraits>);

template <class... Kinds>
std::vector<Layer> make_all_kinds(const std::variant<Kinds...>*) {
  return {Layer(Kinds{})...};
}

TEST(LayerTraits, TellWhatALayerHas) {
  for (const Layer& layer : make_all_kinds(static_cast<const Layer*>(nullptr))) {
    const LayerTraits traits = layer_traits(layer);
    EXPECT_EQ(find_use(layer) != nullptr, traits.is_noise) << type_word(layer);
    const std::string_view word = type_word(layer);
    EXPECT_EQ(find_image(layer) != nullptr, word == "exemplar" || word == "relief") << word;
    EXPECT_FALSE(has_color(layer)) << word;
    EXPECT_EQ(has_height(layer), word != "exemplar" && word != "gabor") << word;
  }
}

TEST(LayerTraits, APopulationBelongsToLandforms) {
  CraterLayer craters;
  EXPECT_EQ(find_population(Layer(craters)), nullptr);
  craters.population.emplace();
  EXPECT_NE(find_population(Layer(craters)), nullptr);
  EXPECT_EQ(find_population(Layer(FractalLayer{})), nullptr);
}

TEST(LayerTraits, AnExemplarPaintsUnlessItOnlyServesOthers) {
  ExemplarLayer exemplar;
  exemplar.color = true;
  EXPECT_TRUE(has_color(exemplar));
  EXPECT_TRUE(paints(exemplar));
  EXPECT_FALSE(has_height(exemplar));
  exemplar.use.combination.kind = Combine::kMask;
  EXPECT_FALSE(paints(exemplar));
  exemplar.height_range = -0.5;
  EXPECT_TRUE(has_height(exemplar));
}

TEST(LayerTraits, AGaborLayerHasColorsForPlanesAlone) {
  GaborLayer gabor;
  gabor.color.emplace();
  EXPECT_TRUE(has_color(gabor));
  EXPECT_FALSE(paints(gabor));
  EXPECT_FALSE(has_height(gabor));
}

// Reliefs that hold their pixels in the recipe.

// A relief of 40 x 30 pixels with an empty border.
Recipe with_relief(int levels = 91) {
  ReliefLayer layer;
  layer.spacing = 0.25;
  layer.low = -1.5, layer.high = 0.75;
  layer.levels = levels;
  ExemplarImage image{40, 30, std::vector<std::uint16_t>(1200, 0), {}};
  for (int y = 2; y < 28; ++y) {
    for (int x = 3; x < 36; ++x) {
      const int code = (x * x + 7 * y + 3 * x * y) % levels;
      image.values[static_cast<std::size_t>(40 * y + x)] =
          layer.code_to_grey(static_cast<std::uint16_t>(code));
    }
  }
  layer.pixels = std::make_shared<ExemplarImage>(image);
  Recipe recipe;
  recipe.body = MetaballBody{};
  recipe.body->spheres = {{{}, 1.0}};
  recipe.layers = {layer};
  return recipe;
}

const ExemplarImage& find_pixels(const Recipe& recipe) {
  return *std::get<ReliefLayer>(recipe.layers[0]).pixels;
}

TEST(ReliefText, ComesBackFromJsonAndFromACompactRecipe) {
  for (const int levels : {2, 91, 65535}) {
    const Recipe recipe = with_relief(levels);
    const std::string json = recipe_to_json(recipe), compact = recipe_to_compact(recipe);
    EXPECT_LT(compact.size(), json.size());
    for (const std::string& text : {json, compact}) {
      const Recipe read = parse_recipe(text, "test");
      EXPECT_EQ(find_pixels(read).width, 40);
      EXPECT_EQ(find_pixels(read).values, find_pixels(recipe).values);
      EXPECT_EQ(recipe_to_json(read), json);
    }
  }
}

TEST(ReliefText, GreyValuesAndCodesAreEachOthers) {
  for (const int levels : {2, 3, 87, 4096, 65535}) {
    ReliefLayer layer;
    layer.levels = levels;
    for (int code = 0; code < levels; ++code) {
      const std::uint16_t value = layer.code_to_grey(static_cast<std::uint16_t>(code));
      ASSERT_GT(value, 0);
      ASSERT_EQ(layer.grey_to_code(value), code) << levels;
    }
    EXPECT_EQ(layer.code_to_grey(static_cast<std::uint16_t>(levels - 1)), 65535);
  }
}

TEST(ReliefText, RefusesWhatIsDamagedOrMissing) {
  const std::string json = recipe_to_json(with_relief());
  const std::size_t at = json.find("\"heights\": \"") + 12;
  const auto refused = [](const std::string& text) {
    try {
      parse_recipe(text, "test");
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  std::string spoiled = json;
  spoiled[at + 5] = '*';
  EXPECT_NE(refused(spoiled).find("test: layers[0].heights: is damaged"), std::string::npos)
      << refused(spoiled);
  spoiled = json;
  spoiled.erase(at, json.find('"', at) - at);
  EXPECT_NE(refused(spoiled).find("layers[0]"), std::string::npos) << refused(spoiled);
  // Fewer levels than the codes have.
  spoiled = json;
  spoiled.replace(spoiled.find("\"levels\": 91"), 12, "\"levels\": 5");
  EXPECT_NE(refused(spoiled).find("layers[0].heights: is damaged"), std::string::npos) << refused(spoiled);
  const std::string compact = recipe_to_compact(with_relief());
  EXPECT_NE(refused(compact.substr(0, compact.size() - 40)), "");
}

}  // namespace
}  // namespace astrolith
