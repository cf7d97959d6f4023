#include "recipe/recipe_json.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "tests/recipe/recipe_examples.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

namespace astrolith {
namespace {

std::string error_message(const std::string& text) {
  return testing::refusal_text([&] { parse_recipe(text, "rock.json"); });
}

void expect_error(const std::string& text, const std::string& part) {
  const std::string error = error_message(text);
  EXPECT_NE(error.find(part), std::string::npos) << "error is: " << error << "\nwanted: " << part;
  EXPECT_EQ(error.rfind("rock.json: ", 0), 0u) << error;
  EXPECT_EQ(error.find('\n'), std::string::npos) << error;
}

void expect_same_bits(double a, double b) {
  EXPECT_EQ(std::bit_cast<std::uint64_t>(a), std::bit_cast<std::uint64_t>(b)) << a << " " << b;
}

TEST(RecipeJson, ReadsEveryField) {
  const Recipe r = parse_recipe(testing::kCompleteRecipe, "r");
  EXPECT_EQ(r.length_unit, "km");
  EXPECT_EQ(r.frame, "body-fixed");
  EXPECT_EQ(r.seed, 9007199254740991u);
  EXPECT_EQ(r.provenance.input_name, "rock.obj");
  EXPECT_EQ(r.provenance.options.at(0), std::make_pair(std::string("spheres"), std::string("2")));
  EXPECT_EQ(r.provenance.achieved.at(0), std::make_pair(std::string("mean_distance"), 0.001));
  ASSERT_TRUE(r.body.has_value());
  EXPECT_EQ(r.body->a, 1.5);
  EXPECT_EQ(r.body->b, 1.25);
  EXPECT_EQ(r.body->blend_exponent, 2);
  ASSERT_EQ(r.body->spheres.size(), 2u);
  EXPECT_EQ(r.body->spheres[1].center, (Vec3d{0.5, -0.25, 1e-3}));
  EXPECT_EQ(r.body->spheres[1].radius, 0.75);
  const auto& simplex = std::get<FractalLayer>(r.layers.at(0));
  EXPECT_EQ(simplex.name, "grit");
  EXPECT_EQ(simplex.octaves, 6);
  EXPECT_EQ(simplex.scale, (Vec3d{1, 1, 2}));
  EXPECT_EQ(simplex.bias, (Vec3d{0.5, 0, 0}));
  EXPECT_EQ(simplex.gradient_modulation, 0.25);
  EXPECT_EQ(r.description, "two spheres");
  EXPECT_EQ(r.body->warp.value().lacunarity, 2.5);
  const auto& worley = std::get<FractalLayer>(r.layers.at(2));
  EXPECT_EQ(worley.noise, Noise::kWorleyF2MinusF1);
  EXPECT_EQ(worley.warp.value().frequency, 4.0);
  EXPECT_EQ(std::get<FractalLayer>(r.layers.at(3)).noise, Noise::kPerlin);
  const auto& gabor = std::get<GaborLayer>(r.layers.at(1));
  EXPECT_EQ(gabor.pixel_size, 0.001);
  ASSERT_TRUE(gabor.color.has_value());
  EXPECT_EQ(gabor.color->axis, (Vec3d{0.6, 0.8, 0}));
  EXPECT_EQ(gabor.color->mean, (Vec3d{0.5, 0.25, 0.1}));
  EXPECT_EQ(gabor.lobes.at(1).bandwidth, 12);
  EXPECT_EQ(gabor.lobes.at(0).frequency_y, -0.25);
  EXPECT_EQ(gabor.lobes.at(0).variance, 0.75);
}

TEST(RecipeJson, AbsentFieldsHaveTheirDefaults) {
  const Recipe r = parse_recipe(R"({"format_version": 1, "length_unit": "m",
      "body": {"type": "metaballs", "spheres": [[0, 0, 0, 1]]}, "layers": [{"type": "simplex"}]})",
                                "r");
  EXPECT_EQ(r.seed, 1u);
  EXPECT_EQ(r.frame, Recipe{}.frame);
  EXPECT_EQ(r.body->cutoff_radii, 5.0);
  EXPECT_EQ(std::get<FractalLayer>(r.layers.at(0)).lacunarity, 1.95);
}

TEST(RecipeJson, WritingAndReadingAreInverse) {
  const std::string text = recipe_to_json(parse_recipe(testing::kCompleteRecipe, "r"));
  EXPECT_EQ(recipe_to_json(parse_recipe(text, "r")), text);
}

// The numbers are doubles of every magnitude with all 53 bits in use, zeros, subnormals and limits.
TEST(RecipeJson, NumbersKeepTheirBits) {
  Recipe recipe;
  recipe.body.emplace();
  std::vector<double> values{0.0, -0.0, 0.1, 1.0 / 3, 5e-324, -2.2250738585072014e-308, 1e12, 123456789012.0};
  CounterRandom random(9);
  for (int i = 0; i < 2000; ++i) {
    values.push_back(random.uniform(-1, 1) * std::pow(10.0, random.uniform(-300, 12)));
  }
  for (double v : values) recipe.body->spheres.push_back({{v, -v, 0}, std::fmax(std::fabs(v), 1e-12)});
  const Recipe read = parse_recipe(recipe_to_json(recipe), "r");
  ASSERT_EQ(read.body->spheres.size(), values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    expect_same_bits(read.body->spheres[i].center.x, recipe.body->spheres[i].center.x);
    expect_same_bits(read.body->spheres[i].center.y, recipe.body->spheres[i].center.y);
    expect_same_bits(read.body->spheres[i].radius, recipe.body->spheres[i].radius);
  }
}

TEST(RecipeJson, TwoHundredSpheresAreTwelveKilobytesOneALine) {
  Recipe recipe;
  recipe.body.emplace();
  CounterRandom random(4);
  const auto value = [&](double low, double high) {
    return round_to_seven_digits(random.uniform(low, high));
  };
  for (int i = 0; i < 200; ++i) {
    recipe.body->spheres.push_back(
        {{value(-0.3, 0.3), value(-0.15, 0.15), value(-0.1, 0.1)}, value(0.005, 0.1)});
  }
  const std::string text = recipe_to_json(recipe);
  EXPECT_LT(text.size(), 12000u);
  const auto lines = std::count(text.begin(), text.end(), '\n');
  EXPECT_GT(lines, 200);
  EXPECT_LT(lines, 240);
}

TEST(RecipeJson, SevenDigitsKeepAFloatsPrecision) {
  CounterRandom random(11);
  for (int i = 0; i < 1000; ++i) {
    const double x = random.uniform(-1, 1) * std::pow(10.0, random.uniform(-12, 12));
    EXPECT_NEAR(round_to_seven_digits(x), x, 5.0001e-7 * std::fabs(x));
  }
  EXPECT_EQ(round_to_seven_digits(0.123456749), 0.1234567);
  EXPECT_EQ(round_to_seven_digits(-2.0), -2.0);
  EXPECT_EQ(round_to_seven_digits(0.0), 0.0);
}

TEST(RecipeJson, StringsSurvive) {
  Recipe recipe = parse_recipe(testing::kCompleteRecipe, "r");
  recipe.frame = "quote \" backslash \\ line\nbreak \t tab \x01 \xc3\xa9";
  EXPECT_EQ(parse_recipe(recipe_to_json(recipe), "r").frame, recipe.frame);
  recipe.frame = "latin-1 \xe9";
  EXPECT_EQ(parse_recipe(recipe_to_json(recipe), "r").frame, "latin-1 \xef\xbf\xbd");
}

TEST(RecipeJson, ErrorsNameFilePathAndRemedy) {
  for (const testing::Spoiled& change : testing::spoiled_recipes()) {
    ASSERT_NE(testing::kCompleteRecipe.find(change.from), std::string::npos) << change.from;
    expect_error(testing::spoil(change), change.error);
  }
  expect_error(R"({"format_version": 1, "length_unit": "m"})", "has neither a body nor layers");
  expect_error("[]", "must be an object, is an array of 0");
}

// Older recipes state the evaluation of Gabor noise, of which one is left.
TEST(RecipeJson, TheOneEvaluationMayBeStated) {
  const std::string old =
      testing::spoil({R"("exemplar_mean": 0.4)", R"("evaluation": "impulses", "exemplar_mean": 0.4)", ""});
  EXPECT_EQ(recipe_to_json(parse_recipe(old, "r")),
            recipe_to_json(parse_recipe(testing::kCompleteRecipe, "r")));
}

TEST(RecipeJson, SyntaxErrorsGiveLineAndColumn) {
  expect_error("", "line 1, column 1: not valid JSON");
  expect_error("{\n  \"format_version\": 1,\n  oops\n}", "line 3, column 3: not valid JSON");
  expect_error("{\n  \"seed\": NaN}", "line 2, column 11");
  expect_error(R"({"seed": Infinity})", "not valid JSON");
  expect_error(R"({"seed": 1e999})", "not valid JSON: the number \"1e999\" is too large");
  const auto lines = std::count(testing::kCompleteRecipe.begin(), testing::kCompleteRecipe.end(), '\n');
  expect_error(testing::kCompleteRecipe + "x",
               "line " + std::to_string(lines + 1) + ", column 1: not valid JSON");
  expect_error("{\"frame\": \"\xff\xfe\"}", "not valid JSON: a text is not UTF-8");
  expect_error("{\"frame\": \"a\nb\"}", "not valid JSON");
  expect_error(std::string("\x89PNG\r\n\x1a\n\0\0\0", 11), "line 1, column 1: not valid JSON");
}

// A syntax error names the text at fault and a remedy, without words that only a programmer knows.
TEST(RecipeJson, SyntaxErrorsAreSaidPlainly) {
  expect_error("", "the text ends in the middle of a value; is the file cut off?");
  expect_error(R"({"a": 1)", "the text ends in the middle");
  expect_error(R"({"a" 1})", R"("1" stands where the colon after a field's name should)");
  expect_error(R"({"a": 1,})", R"("}" stands where a field's name should)");
  expect_error("{oops: 1}", R"("oops" stands where a field's name should, in quotes)");
  expect_error("[1,]", R"("]" stands where a value should; write one, or remove a comma)");
  expect_error("[1 2]", R"("2" stands where a comma or a closing bracket should)");
  expect_error(R"({"a":1 "b":2})", "stands where a comma or a closing brace should");
  expect_error(R"({"a": NaN})", R"("NaN" is no value; write a number, true, false or a text in quotes)");
  expect_error("{} {}", R"("{" stands behind the end of the recipe)");
  expect_error(R"({"a": "b)", "has no closing quote");
  expect_error(R"({"a": -})", R"(is no number; write it like -0.5 or 2e-3)");
  for (const char* bad :
       {"", "{", "{\"a\"", "[1,]", "[1 2]", "nan", "-", "\"\\x\"", "{}{}", "\xff", "// no"}) {
    const std::string error = error_message(bad);
    EXPECT_NE(error, "no error") << bad;
    for (const char* jargon : {"literal", "exception", "syntax", "parsing", "token"}) {
      EXPECT_FALSE(testing::has(error, jargon));
    }
  }
}

TEST(RecipeJson, KeysStandOnce) {
  expect_error(R"({"seed": 1, "seed": 1})", "the field \"seed\" stands twice");
  expect_error(R"({"provenance": {"options": {"a": "1", "a": "2"}}})", "the field \"a\" stands twice");
}

TEST(RecipeJson, CostOfHostileTextIsBounded) {
  expect_error(std::string(100000, '['), "nested deeper than 32 levels");
  expect_error(std::string(std::size_t{65} << 20, ' '), "larger than 64 MB");
  std::string many = "[0";
  for (int i = 0; i < 8'000'000; ++i) many += ",0";
  expect_error(many + "]", "more than 8000000 values");
}

// Every prefix of a document is an error, never a crash or a silent success.
TEST(RecipeJson, TruncatedTextIsAnError) {
  const std::string text = testing::kCompleteRecipe.substr(0, testing::kCompleteRecipe.rfind('}'));
  for (std::size_t n = 0; n <= text.size(); ++n) EXPECT_NE(error_message(text.substr(0, n)), "no error") << n;
}

// Up to four bytes are changed at random. The reader returns a recipe or throws one line of error.
TEST(RecipeJson, DamagedTextIsReadOrRefused) {
  CounterRandom random(21);
  int refused = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string text = testing::kCompleteRecipe;
    for (int k = 0; k <= i % 4; ++k) text[random.below(text.size())] = static_cast<char>(random.below(256));
    const std::string error = error_message(text);
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    if (error != "no error") ++refused;
  }
  EXPECT_GT(refused, 1500);
}

TEST(RecipeJson, InvalidRecipesAreNotWritten) {
  Recipe recipe = parse_recipe(testing::kCompleteRecipe, "r");
  recipe.body->spheres[0].radius = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(recipe_to_json(recipe), WorkError);
  recipe = parse_recipe(testing::kCompleteRecipe, "r");
  recipe.provenance.achieved = {{"b", 1.0}, {"a", 1.0}};
  EXPECT_THROW(recipe_to_json(recipe), WorkError);
  recipe.provenance.achieved = {{"a", std::numeric_limits<double>::infinity()}};
  EXPECT_THROW(recipe_to_json(recipe), WorkError);
}

TEST(RecipeJson, OperationsAreBoundedInDepth) {
  const auto nested = [](int depth) {
    std::string body = R"({"type": "metaballs", "spheres": [[0, 0, 0, 1]]})";
    for (int i = 0; i < depth; ++i) {
      body = R"({"type": "metaballs", "spheres": [[0, 0, 0, 1]], "operations": [{"type": "union", "body": )" +
             body + "}]}";
    }
    return R"({"format_version": 1, "length_unit": "m", "body": )" + body + "}";
  };
  EXPECT_EQ(parse_recipe(nested(5), "r").body->operations.size(), 1u);
  expect_error(nested(9), "body.operations: must be at most 256 in all and 8 deep");
}

TEST(RecipeJson, Files) {
  const testing::ScratchFolder folder;
  const Recipe recipe = parse_recipe(testing::kCompleteRecipe, "r");
  write_recipe(recipe, folder / "r.json");
  EXPECT_EQ(recipe_to_json(read_recipe(folder / "r.json")), recipe_to_json(recipe));
  EXPECT_THROW(read_recipe(folder / "absent.json"), InputError);
  EXPECT_THROW(read_recipe(folder.path()), InputError);
  EXPECT_THROW(read_recipe(folder / std::string(5000, 'x')), InputError);
  EXPECT_THROW(write_recipe(recipe, folder / "absent/r.json"), InputError);
}

}  // namespace
}  // namespace astrolith
