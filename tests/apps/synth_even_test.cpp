// synth --even, run as a user runs it.
#include <nlohmann/json.hpp>

#include "geometry/io/mesh_io.h"
#include "geometry/mesh_topology.h"
#include "tests/apps/synth_runner.h"

namespace astrolith {
namespace {

using testing::expect_refusal;
using testing::Outcome;
using testing::run_program;
using testing::text_of;
using Json = nlohmann::json;

class SynthEven : public SynthTest {
 protected:
  // Runs with these options and a summary, which it returns.
  Json summary_of(std::vector<std::string> options) {
    const std::string summary = (folder_ / "summary.json").string();
    options.insert(options.begin(), folder_.write("r.json", kTwoSpheres));
    options.insert(options.end(), {"--summary", summary});
    const Outcome outcome = run_program(kSynth, options);
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    said_ = outcome.errors;
    return Json::parse(text_of(summary));
  }

  std::string said_;
};

TEST_F(SynthEven, SummaryAndWordsStateWhatWasDone) {
  const std::string mesh = (folder_ / "even.ply").string();
  const Json summary = summary_of({"-o", mesh, "--resolution", "64", "--even"});
  const Json& even = summary["even"];
  EXPECT_GT(even["quality_after"]["first_percentile"], 0.5);
  EXPECT_GT(even["quality_after"]["mean"], even["quality_before"]["mean"]);
  EXPECT_LT(even["quality_before"]["first_percentile"], 0.1);
  EXPECT_GT(even["mean_move"], 0.1 * summary["cell"].get<double>());
  EXPECT_GT(even["largest_move"], even["mean_move"]);
  EXPECT_LT(even["largest_move"], 2.0 * summary["cell"].get<double>());
  EXPECT_LT(even["largest_value"], 0.04 * summary["cell"].get<double>());
  EXPECT_EQ(even["moved_vertices"].get<int>() + even["kept_vertices"].get<int>(), summary["vertices"]);
  EXPECT_TRUE(summary["closed"] && summary["manifold"]);
  EXPECT_NE(said_.find("even: quality 0."), std::string::npos) << said_;
  EXPECT_NE(said_.find(" km in the mean"), std::string::npos) << said_;
  EXPECT_TRUE(analyze_topology(read_mesh(mesh)).closed);
}

TEST_F(SynthEven, SameBytesForAnyThreadsAndTheSameTrianglesAsWithout) {
  const std::string one = synthesise("a.ply", {"--even", "--threads", "1"});
  EXPECT_EQ(synthesise("b.ply", {"--even", "--threads", "2"}), one);
  EXPECT_EQ(synthesise("c.ply", {"--even", "--threads", "5"}), one);
  EXPECT_NE(synthesise("plain.ply", {}), one);
  EXPECT_EQ(read_mesh(folder_ / "a.ply").triangles, read_mesh(folder_ / "plain.ply").triangles);
}

TEST_F(SynthEven, OtherFormatsAndOptionsHaveIt) {
  synthesise("even.obj", {"--even"});
  synthesise("even.glb", {"--even"});
  synthesise("even.ply.zst", {"--even", "--min-component", "0.001"});
  synthesise("labels.ply", {"--even", "--labels"});
  synthesise("patch.ply", {"--even", "--patch", "-1", "0", "0", "0.5"});
  const Json predicted = summary_of({"--predict", "--resolution", "64", "--even"})["predicted"];
  const Json plain = summary_of({"--predict", "--resolution", "64"})["predicted"];
  EXPECT_GT(predicted["peak_bytes"], plain["peak_bytes"]);
}

TEST_F(SynthEven, TilesStillJoin) {
  std::vector<std::string> summaries;
  for (const char* tile : {"1", "2", "3"}) {
    const std::string name = "tile_" + std::string(tile), summary = (folder_ / (name + ".json")).string();
    std::vector<std::string> options{"--tile", std::string(tile) + "/3", "--summary", summary};
    if (tile[0] != '2') options.push_back("--even");  // a plain tile fits even ones
    synthesise(name + ".ply", options);
    summaries.push_back(summary);
  }
  const Outcome checked = run_program(ASTROLITH_CHECK_TILES, summaries);
  EXPECT_EQ(checked.status, 0) << checked.errors;
}

TEST_F(SynthEven, WhatCannotHaveItIsRefused) {
  const std::string recipe = folder_.write("r.json", kTwoSpheres);
  const auto refused = [&](std::vector<std::string> options, const std::string& culprit) {
    options.insert(options.begin(), recipe);
    options.push_back("--even");
    expect_refusal(folder_, kSynth, options, culprit);
  };
  refused({"-o", (folder_ / "m.icq").string(), "--resolution", "16"}, "leave out --even");
  refused({"-o", (folder_ / "t.png").string(), "--texture", "64x64"}, "--even");
}

}  // namespace
}  // namespace astrolith
