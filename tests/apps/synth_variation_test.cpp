// synth, run as a user runs it: variations.
#include <nlohmann/json.hpp>

#include "recipe/sha256.h"
#include "tests/apps/synth_runner.h"

namespace astrolith {
namespace {

using testing::expect_refusal;
using testing::run_program;
using testing::text_of;

using SynthVariation = SynthTest;

TEST_F(SynthVariation, VariationsAreAsAlikeAsAskedAndStayInOnePiece) {
  const std::string summary_file = (folder_ / "s.json").string();
  const std::string itself = synthesise("itself.ply", {});
  const std::string one = synthesise("one.ply", {"--vary", "0.3", "--seed", "1", "--summary", summary_file});
  const auto summary = nlohmann::json::parse(text_of(summary_file));
  EXPECT_GE(summary["similarity"].get<double>(), 0.7);
  EXPECT_EQ(summary["similarity_with"], "recipe");
  EXPECT_GT(summary["variation"]["mean_distance"].get<double>(), 1e-3);
  EXPECT_GT(summary["variation"]["max_distance"], summary["variation"]["mean_distance"]);
  EXPECT_GT(summary["variation"]["strength"].get<double>(), 0.0);
  EXPECT_EQ(summary["components"].get<int>(), 1);
  EXPECT_FALSE(one == itself);
  expect_refusal(folder_, kSynth,
                 {(folder_ / "r.json").string(), "-o", (folder_ / "no.ply").string(), "--vary", "1.5"},
                 "--vary");
}

// Two samplings of one body are less alike than 0.999, so that every other body is refused. The similarity
// that the refusal offers can be had.
TEST_F(SynthVariation, AVariationThatWouldBeTheSameBodyIsRefused) {
  const std::string recipe = folder_.write("r.json", kTwoSpheres), out = (folder_ / "out.ply").string();
  std::vector<std::string> arguments{recipe, "-o", out, "--resolution", "32", "--vary", "0.001"};
  const testing::Outcome refused = run_program(kSynth, arguments);
  const std::string& refusal = refused.errors;
  EXPECT_EQ(refused.status, 2);
  ASSERT_EQ(refusal.rfind("synth: variation 1: no other body with a similarity of 0.999", 0), 0u) << refusal;
  const std::string before = "a difference of ";
  arguments.back() = refusal.substr(refusal.find(before) + before.size(), 6);
  const testing::Outcome outcome = run_program(kSynth, arguments);
  EXPECT_EQ(outcome.status, 0) << refusal << outcome.errors;
  EXPECT_NE(outcome.errors.find("% of the diagonal"), std::string::npos) << outcome.errors;
}

TEST_F(SynthVariation, VariationsCanBeLikeATargetInstead) {
  const std::string summary_file = (folder_ / "s.json").string(), target = (folder_ / "target.ply").string();
  ASSERT_EQ(
      run_program(kSynth, {folder_.write("r.json", kTwoSpheres), "-o", target, "--resolution", "128"}).status,
      0);
  const std::string note = "is not the file that the recipe was fitted to, rock.ply";
  for (const bool fitted : {false, true}) {
    const std::string origin = R"("provenance": {"input_name": "rock.ply", "input_sha256": ")" +
                               (fitted ? sha256_of_file(target) : std::string(64, '0')) + "\"}, \"body\"";
    const testing::Outcome outcome =
        run_program(kSynth, {folder_.write("fit.json", replaced(kTwoSpheres, "\"body\"", origin)), "-o",
                             (folder_ / "out.ply").string(), "--resolution", "32", "--vary", "0.3",
                             "--target", target, "--summary", summary_file});
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    EXPECT_EQ(outcome.errors.find(note) == std::string::npos, fitted) << outcome.errors;
    EXPECT_NE(outcome.errors.find("with " + target), std::string::npos) << outcome.errors;
    EXPECT_EQ(nlohmann::json::parse(text_of(summary_file))["similarity_with"], "target");
  }
  expect_refusal(folder_, kSynth,
                 {(folder_ / "r.json").string(), "-o", (folder_ / "no.ply").string(), "--target", target},
                 "--vary");
}

}  // namespace
}  // namespace astrolith
