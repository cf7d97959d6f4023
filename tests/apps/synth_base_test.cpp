// synth --base and --write-recipe, run as a user runs them.
#include "recipe/recipe_json.h"
#include "tests/apps/synth_runner.h"

namespace astrolith {
namespace {

const std::string kBall = ball_recipe("m", 100, R"(,
  "layers": [{"type": "simplex", "amplitude": 1, "frequency": 0.01, "octaves": 2}])");

// A ball of radius 100 m is 200 m long: 0.01 of it are 2 m.
const std::string kShares = R"({"format_version": 1, "length_unit": "body",
  "layers": [{"type": "simplex", "amplitude": 0.01, "frequency": 5, "octaves": 2}]})";

class SynthBase : public SynthTest {
 protected:
  SynthBase() {
    write("ball.json", kBall);
    write("shares.json", kShares);
  }
};

TEST_F(SynthBase, SharesOfTheBodyBecomeLengthsInItsUnit) {
  succeed("shares.json --base ball.json --write-recipe merged.json");
  const Recipe merged = read_recipe(folder_ / "merged.json");
  EXPECT_EQ(merged.length_unit, "m");
  ASSERT_EQ(merged.layers.size(), 2u);
  const FractalLayer& laid = std::get<FractalLayer>(merged.layers[1]);
  const double side = laid.amplitude / 0.01;
  EXPECT_NEAR(side, 200.0, 1.0);
  EXPECT_NEAR(laid.frequency * side, 5.0, 1e-9);
}

TEST_F(SynthBase, TheWrittenRecipeMakesTheSameMesh) {
  for (const std::string made : {"shares.json --base ball.json --seed 7", "ball.json --vary 0.9 --seed 2"}) {
    succeed(made + " --resolution 32 --write-recipe written.json -o at_once.ply");
    succeed("written.json --resolution 32 -o later.ply");
    EXPECT_EQ(text("at_once.ply"), text("later.ply")) << made;
  }
}

TEST_F(SynthBase, OneThingToMakeIsRequired) {
  refuse("ball.json", "--output: is required");
  EXPECT_GT(figures("ball.json --predict --quiet").at("predicted").at("triangles"), 0);
}

TEST_F(SynthBase, SharesNeedABodyAndHaveNoneThemselves) {
  refuse("shares.json -o a.ply", "body: absent");
  refuse("shares.json --base shares.json -o a.ply", "body: absent");
  refuse(write("bad.json", replaced(kBall, "\"m\"", "\"body\"")) + " -o a.ply", "length_unit: is \"body\"");
}

TEST_F(SynthBase, TheWrittenRecipeIsNotItsInput) {
  refuse("ball.json --write-recipe ball.json", "is the input itself");
  refuse("shares.json --base ball.json --write-recipe ball.json", "is the input itself");
  EXPECT_EQ(text("ball.json"), kBall);
}

}  // namespace
}  // namespace astrolith
