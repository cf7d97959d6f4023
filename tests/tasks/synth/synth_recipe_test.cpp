// synth: recipes that it makes on the way, by --base, --vary and --finish.
#include "numerics/files/sha256.h"
#include "tests/tasks/synth/synth_runner.h"

namespace astrolith {
namespace {

using testing::has;

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

TEST_F(SynthBase, TheWrittenRecipeMakesTheSameMesh) {
  for (const std::string made : {"shares.json --base ball.json --seed 7", "ball.json --vary 0.9 --seed 3"}) {
    succeed(made + " --resolution 32 --write-recipe written.json -o at_once.ply");
    succeed("written.json --resolution 32 -o later.ply");
    EXPECT_EQ(text("at_once.ply"), text("later.ply")) << made;
  }
}

TEST_F(SynthBase, SharesNeedABodyAndHaveNoneThemselves) {
  refuse("shares.json -o a.ply", "body: absent");
  refuse("shares.json --base shares.json -o a.ply", "body: absent");
}

using SynthVariation = SynthTest;

TEST_F(SynthVariation, VariationsAreAsAlikeAsAskedAndStayInOnePiece) {
  const std::string itself = synthesise("itself.ply");
  const std::string one = synthesise("one.ply", "--vary 0.3 --seed 1 --summary s.json");
  const auto summary = json("s.json");
  EXPECT_GE(summary["similarity"], 0.7);
  EXPECT_EQ(summary["similarity_with"], "recipe");
  EXPECT_GT(summary["variation"]["mean_distance"], 1e-3);
  EXPECT_GT(summary["variation"]["max_distance"], summary["variation"]["mean_distance"]);
  EXPECT_GT(summary["variation"]["strength"], 0.0);
  EXPECT_EQ(summary["components"], 1);
  EXPECT_FALSE(one == itself);
}

TEST_F(SynthVariation, VariationsCanBeLikeATargetInstead) {
  succeed("r.json -o target.ply --resolution 128");
  for (const bool fitted : {false, true}) {
    const std::string origin = R"("provenance": {"input_name": "rock.ply", "input_sha256": ")" +
                               (fitted ? file_sha256(folder_ / "target.ply") : std::string(64, '0')) +
                               "\"}, \"body\"";
    write("fit.json", replaced(kTwoSpheres, "\"body\"", origin));
    const std::string said =
        succeed("fit.json -o out.ply --resolution 32 --vary 0.9 --target target.ply --summary s.json");
    EXPECT_EQ(static_cast<bool>(has(said, "is not the file that the recipe was fitted to, rock.ply")),
              !fitted);
    EXPECT_TRUE(has(said, "with target.ply"));
    EXPECT_EQ(json("s.json")["similarity_with"], "target");
  }
}

const std::string kAsteroid = R"({"format_version": 1, "length_unit": "m",
  "body": {"type": "metaballs", "spheres": [[0, 0, 0, 150], [80, 0, 0, 100]]},
  "layers": [{"type": "simplex", "amplitude": 1, "frequency": 0.02, "octaves": 5}]})";

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

}  // namespace
}  // namespace astrolith
