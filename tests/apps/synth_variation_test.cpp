// synth, run as a user runs it: variations.
#include "numerics/files/sha256.h"
#include "tests/apps/synth_runner.h"

namespace astrolith {
namespace {

using testing::has;

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
  refuse("r.json -o no.ply --vary 1.5", "--vary");
}

// Two samplings of one body are less alike than 0.999, so that every other body is refused.
TEST_F(SynthVariation, AVariationThatWouldBeTheSameBodyIsRefusedLong) {
  write("bare.json", kTwoSpheres.substr(0, kTwoSpheres.find(",\n  \"layers\"")) + "}");
  refuse("bare.json -o out.ply --vary 0.001", "variation 1: no other body with a similarity of 0.999");
}

TEST_F(SynthVariation, VariationsCanBeLikeATargetInstead) {
  succeed("r.json -o target.ply --resolution 128");
  for (const bool fitted : {false, true}) {
    const std::string origin = R"("provenance": {"input_name": "rock.ply", "input_sha256": ")" +
                               (fitted ? sha256_of_file(folder_ / "target.ply") : std::string(64, '0')) +
                               "\"}, \"body\"";
    write("fit.json", replaced(kTwoSpheres, "\"body\"", origin));
    const std::string said =
        succeed("fit.json -o out.ply --resolution 32 --vary 0.9 --target target.ply --summary s.json");
    EXPECT_EQ(static_cast<bool>(has(said, "is not the file that the recipe was fitted to, rock.ply")),
              !fitted);
    EXPECT_TRUE(has(said, "with target.ply"));
    EXPECT_EQ(json("s.json")["similarity_with"], "target");
  }
  refuse("r.json -o no.ply --target target.ply", "--vary");
}

}  // namespace
}  // namespace astrolith
