// synth --base and --write-recipe, run as a user runs them.
#include <nlohmann/json.hpp>

#include "recipe/recipe_json.h"
#include "tests/apps/program_runner.h"
#include "tests/apps/synth_runner.h"

namespace astrolith {
namespace {

using testing::expect_refusal;
using testing::run_program;
using testing::text_of;

const std::string kBall = R"({"format_version": 1, "length_unit": "m",
  "body": {"type": "metaballs", "spheres": [[0, 0, 0, 100]]},
  "layers": [{"type": "simplex", "amplitude": 1, "frequency": 0.01, "octaves": 2}]})";

// A ball of radius 100 m is 200 m long: 0.01 of it are 2 m.
const std::string kShares = R"({"format_version": 1, "length_unit": "body",
  "layers": [{"type": "simplex", "amplitude": 0.01, "frequency": 5, "octaves": 2}]})";

class SynthBase : public ::testing::Test {
 protected:
  std::string name(const std::string& file) const { return (folder_ / file).string(); }
  void run(std::vector<std::string> arguments) {
    const testing::Outcome outcome = run_program(kSynth, arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
  }

  testing::WorkFolder folder_;
  const std::string ball_ = folder_.write("ball.json", kBall);
  const std::string shares_ = folder_.write("shares.json", kShares);
};

TEST_F(SynthBase, SharesOfTheBodyBecomeLengthsInItsUnit) {
  run({shares_, "--base", ball_, "--write-recipe", name("merged.json")});
  const Recipe merged = read_recipe(name("merged.json"));
  EXPECT_EQ(merged.length_unit, "m");
  ASSERT_EQ(merged.layers.size(), 2u);
  const FractalLayer& laid = std::get<FractalLayer>(merged.layers[1]);
  const double side = laid.amplitude / 0.01;
  EXPECT_NEAR(side, 200.0, 1.0);
  EXPECT_NEAR(laid.frequency * side, 5.0, 1e-9);
}

TEST_F(SynthBase, TheWrittenRecipeMakesTheSameMesh) {
  run({shares_, "--base", ball_, "--seed", "7", "--resolution", "32", "--write-recipe", name("merged.json"),
       "-o", name("at_once.ply")});
  run({name("merged.json"), "--resolution", "32", "-o", name("later.ply")});
  EXPECT_EQ(text_of(name("at_once.ply")), text_of(name("later.ply")));
}

TEST_F(SynthBase, TheWrittenVariationMakesTheSameMesh) {
  run({ball_, "--vary", "0.3", "--seed", "2", "--resolution", "32", "--write-recipe", name("varied.json"),
       "-o", name("at_once.ply")});
  run({name("varied.json"), "--resolution", "32", "-o", name("later.ply")});
  EXPECT_EQ(text_of(name("at_once.ply")), text_of(name("later.ply")));
}

TEST_F(SynthBase, OneThingToMakeIsRequired) {
  expect_refusal(folder_, kSynth, {ball_}, "--output: is required");
  run({ball_, "--predict", "--quiet", "--summary", name("summary.json")});
  EXPECT_GT(nlohmann::json::parse(text_of(name("summary.json"))).at("predicted").at("triangles"), 0);
}

TEST_F(SynthBase, SharesNeedABodyAndHaveNoneThemselves) {
  expect_refusal(folder_, kSynth, {shares_, "-o", name("a.ply")}, "body: absent");
  expect_refusal(folder_, kSynth, {shares_, "--base", shares_, "-o", name("a.ply")}, "body: absent");
  std::string with_body = kBall;
  with_body.replace(with_body.find("\"m\""), 3, "\"body\"");
  expect_refusal(folder_, kSynth, {folder_.write("bad.json", with_body), "-o", name("a.ply")},
                 "length_unit: is \"body\"");
}

TEST_F(SynthBase, TheWrittenRecipeIsNotItsInput) {
  expect_refusal(folder_, kSynth, {ball_, "--write-recipe", ball_}, "is the input itself");
  expect_refusal(folder_, kSynth, {shares_, "--base", ball_, "--write-recipe", ball_}, "is the input itself");
  EXPECT_EQ(text_of(ball_), kBall);
}

}  // namespace
}  // namespace astrolith
