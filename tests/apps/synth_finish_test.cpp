// synth, run as a user runs it: populations that vary over the body, and --finish.
#include "tests/apps/synth_runner.h"

namespace astrolith {
namespace {

using testing::has;

const std::string kAsteroid = R"({"format_version": 1, "length_unit": "m",
  "body": {"type": "metaballs", "spheres": [[0, 0, 0, 150], [80, 0, 0, 100]]},
  "layers": [{"type": "simplex", "amplitude": 1, "frequency": 0.02, "octaves": 5}]})";

const std::string kRegions = R"({"format_version": 1, "length_unit": "m",
  "body": {"type": "metaballs", "spheres": [[0, 0, 0, 150], [80, 0, 0, 100]], "groups": {"head": [1]}},
  "layers": [{"type": "simplex", "name": "where", "amplitude": 1, "frequency": 0.01, "combine": {"type": "mask"}},
    {"type": "craters", "population": {"count": 60, "least_diameter": 10, "greatest_diameter": 60,
     "depth_deviation": 0.3, "locality": {"group": "head", "width": 5}}},
    {"type": "boulders", "population": {"count": 300, "least_diameter": 6, "greatest_diameter": 30,
     "mask": {"layer": "where", "from": 0, "to": 0.3}, "weibull": {"scale": 8, "shape": 0.8},
     "clusters": {"number": 9, "radius": 20, "share": 0.5}}}]})";

class SynthFinish : public SynthTest {
 protected:
  SynthFinish() { write("a.json", kAsteroid); }
};

TEST_F(SynthFinish, APatchHasTheLandformsOfAKnownBody) {
  std::vector<std::string> bytes;
  for (const std::string threads : {"1", "2"}) {
    const std::string said = succeed(
        "a.json -o p.ply --finish itokawa --from 4 --to 0.2 --patch 0 0 159 8 --resolution 64 "
        "--summary s.json --threads " +
        threads);
    EXPECT_TRUE(has(said, "finish itokawa: boulders of 0.2 to 4 m, 17"));
    EXPECT_TRUE(has(said, "drawn by the law that was measured from 5 m up"));
    bytes.push_back(text("p.ply"));
  }
  EXPECT_EQ(bytes[0], bytes[1]);
  const auto summary = json("s.json");
  EXPECT_EQ(summary["finish"]["body"], "itokawa");
  EXPECT_EQ(summary["finish"]["layers"][0]["layer"], 1);
  EXPECT_EQ(summary["finish"]["layers"][0]["measured_from"], 5.0);
  EXPECT_TRUE(summary["manifold"]);
  EXPECT_TRUE(summary["layers_left_out"].empty());
}

TEST_F(SynthFinish, APatchOfTooManyLandformsIsRefusedInWordsOfTheOption) {
  refuse("a.json -o p.ply --finish itokawa --from 4 --to 0.002 --patch 0 0 159 30",
         "--to: a patch of side 30 would hold");
}

TEST_F(SynthFinish, TheWrittenRecipeMakesTheSamePatch) {
  const std::string patch = " --patch 0 0 159 6 --resolution 32";
  succeed("a.json -o a.ply --finish bennu --from 4 --to 0.4 --write-recipe made.json" + patch);
  succeed("made.json -o b.ply" + patch);
  EXPECT_EQ(text("a.ply"), text("b.ply"));
}

TEST_F(SynthFinish, AWholeBodySaysWhatItLacks) {
  const std::string said =
      succeed("a.json -o w.ply --finish ryugu --from 4 --to 0.05 --resolution 24 --summary s.json");
  EXPECT_TRUE(has(said, "more than the 2e5 landforms that a whole body gets"));
  const auto left_out = json("s.json")["layers_left_out"];
  ASSERT_EQ(left_out.size(), 1u);
  EXPECT_GT(left_out[0]["landforms"], 1e7);
}

TEST_F(SynthFinish, NoneAddsNothing) { EXPECT_EQ(synthesise("b.ply", "--finish none"), synthesise("a.ply")); }

TEST_F(SynthFinish, RefusesInOneLine) {
  refuse("a.json -o m.ply --finish itokawa", "--to");
  refuse("a.json -o m.ply --finish vesta --to 1", "--finish");
  refuse("a.json -o m.ply --finish eros --from 1 --to 2", "a.json: finish: sizes go from 1 down to 2");
  write("px.json", replaced(kAsteroid, "\"m\"", "\"px\""));
  refuse("px.json -o m.ply --finish eros --to 2", "px.json: length_unit: \"px\"");
}

// Populations that vary over the body: predicted triangles, equal bytes, a closed mesh.
TEST_F(SynthFinish, RegionsArePredictedAndClosed) {
  write("r.json", kRegions);
  const std::string line = "r.json -o m.ply --resolution 96";
  std::vector<std::string> bytes;
  nlohmann::json made;
  for (const std::string threads : {"1", "3"}) {
    made = figures(line + " --threads " + threads);
    bytes.push_back(text("m.ply"));
    EXPECT_TRUE(made["closed"]);
    EXPECT_TRUE(made["manifold"]);
  }
  EXPECT_EQ(bytes[0], bytes[1]);
  const double triangles = made["triangles"];
  EXPECT_NEAR(figures(line + " --predict")["predicted"]["triangles"], triangles, 0.2 * triangles);
}

}  // namespace
}  // namespace astrolith
