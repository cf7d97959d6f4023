// synth, run as a user runs it: populations that vary over the body, and --finish.
#include <nlohmann/json.hpp>

#include "tests/apps/synth_runner.h"

namespace astrolith {
namespace {

using testing::expect_refusal;
using testing::run_program;
using testing::text_of;

using SynthFinish = SynthTest;

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

TEST_F(SynthFinish, APatchHasTheLandformsOfAKnownBody) {
  const std::string summary = (folder_ / "s.json").string();
  std::vector<std::string> bytes;
  for (const char* threads : {"1", "2"}) {
    const std::string mesh = (folder_ / "p.ply").string();
    const testing::Outcome outcome = run_program(kSynth, {folder_.write("a.json", kAsteroid),
                                                          "-o",
                                                          mesh,
                                                          "--finish",
                                                          "itokawa",
                                                          "--from",
                                                          "4",
                                                          "--to",
                                                          "0.2",
                                                          "--patch",
                                                          "0",
                                                          "0",
                                                          "159",
                                                          "8",
                                                          "--resolution",
                                                          "64",
                                                          "--threads",
                                                          threads,
                                                          "--summary",
                                                          summary});
    ASSERT_EQ(outcome.status, 0) << outcome.errors;
    EXPECT_NE(outcome.errors.find("finish itokawa: boulders of 0.2 to 4 m, 17"), std::string::npos)
        << outcome.errors;
    EXPECT_NE(outcome.errors.find("drawn by the law that was measured from 5 m up"), std::string::npos);
    bytes.push_back(text_of(mesh));
  }
  EXPECT_EQ(bytes[0], bytes[1]);
  const auto figures = nlohmann::json::parse(text_of(summary));
  EXPECT_EQ(figures["finish"]["body"], "itokawa");
  EXPECT_EQ(figures["finish"]["layers"][0]["layer"], 1);
  EXPECT_EQ(figures["finish"]["layers"][0]["measured_from"], 5.0);
  EXPECT_TRUE(figures["manifold"]);
  EXPECT_TRUE(figures["layers_left_out"].empty());
}

TEST_F(SynthFinish, TheWrittenRecipeMakesTheSamePatch) {
  const std::string recipe = folder_.write("a.json", kAsteroid), made = (folder_ / "made.json").string();
  const std::vector<std::string> patch{"--patch", "0", "0", "159", "6", "--resolution", "32"};
  std::vector<std::string> at_once{
      recipe,           "-o", (folder_ / "a.ply").string(), "--finish", "bennu", "--from", "4", "--to", "0.4",
      "--write-recipe", made};
  std::vector<std::string> later{made, "-o", (folder_ / "b.ply").string()};
  for (auto* arguments : {&at_once, &later}) {
    arguments->insert(arguments->end(), patch.begin(), patch.end());
    const testing::Outcome outcome = run_program(kSynth, *arguments);
    ASSERT_EQ(outcome.status, 0) << outcome.errors;
  }
  EXPECT_EQ(text_of(folder_ / "a.ply"), text_of(folder_ / "b.ply"));
}

TEST_F(SynthFinish, AWholeBodySaysWhatItLacks) {
  const std::string summary = (folder_ / "s.json").string();
  const testing::Outcome outcome = run_program(
      kSynth, {folder_.write("a.json", kAsteroid), "-o", (folder_ / "w.ply").string(), "--finish", "ryugu",
               "--from", "4", "--to", "0.05", "--resolution", "24", "--summary", summary});
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_NE(outcome.errors.find("more than the 2e5 landforms that a whole body gets"), std::string::npos)
      << outcome.errors;
  const auto left_out = nlohmann::json::parse(text_of(summary))["layers_left_out"];
  ASSERT_EQ(left_out.size(), 1u);
  EXPECT_GT(left_out[0]["landforms"].get<double>(), 1e7);
}

TEST_F(SynthFinish, NoneAddsNothing) {
  const std::string plain = synthesise("a.ply", {});
  EXPECT_EQ(synthesise("b.ply", {"--finish", "none"}), plain);
}

TEST_F(SynthFinish, RefusesInOneLine) {
  const std::string recipe = folder_.write("a.json", kAsteroid), mesh = (folder_ / "m.ply").string();
  expect_refusal(folder_, kSynth, {recipe, "-o", mesh, "--finish", "itokawa"}, "--to");
  expect_refusal(folder_, kSynth, {recipe, "-o", mesh, "--finish", "vesta", "--to", "1"}, "--finish");
  expect_refusal(folder_, kSynth, {recipe, "-o", mesh, "--finish", "eros", "--from", "1", "--to", "2"},
                 "a.json: finish: sizes go from 1 down to 2");
  const std::string pixels = folder_.write("px.json", replaced(kAsteroid, "\"m\"", "\"px\""));
  expect_refusal(folder_, kSynth, {pixels, "-o", mesh, "--finish", "eros", "--to", "2"},
                 "px.json: length_unit: \"px\"");
}

// Populations that vary over the body: predicted triangles, equal bytes, a closed mesh.
TEST_F(SynthFinish, RegionsArePredictedAndClosed) {
  const std::string recipe = folder_.write("r.json", kRegions), summary = (folder_ / "s.json").string();
  std::vector<std::string> bytes;
  nlohmann::json made;
  for (const char* threads : {"1", "3"}) {
    const std::string mesh = (folder_ / "m.ply").string();
    const testing::Outcome outcome = run_program(
        kSynth, {recipe, "-o", mesh, "--resolution", "96", "--threads", threads, "--summary", summary});
    ASSERT_EQ(outcome.status, 0) << outcome.errors;
    bytes.push_back(text_of(mesh));
    made = nlohmann::json::parse(text_of(summary));
    EXPECT_TRUE(made["closed"]);
    EXPECT_TRUE(made["manifold"]);
  }
  EXPECT_EQ(bytes[0], bytes[1]);
  const testing::Outcome outcome = run_program(
      kSynth,
      {recipe, "-o", (folder_ / "x.ply").string(), "--resolution", "96", "--predict", "--summary", summary});
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const auto predicted = nlohmann::json::parse(text_of(summary))["predicted"];
  const double triangles = made["triangles"].get<double>();
  EXPECT_NEAR(predicted["triangles"].get<double>(), triangles, 0.2 * triangles);
}

}  // namespace
}  // namespace astrolith
