// synth --even, run as a user runs it.
#include <nlohmann/json.hpp>

#include "geometry/io/mesh_io.h"
#include "geometry/mesh_topology.h"
#include "tests/apps/synth_runner.h"

namespace astrolith {
namespace {

using Json = nlohmann::json;
using SynthEven = SynthTest;

TEST_F(SynthEven, SummaryAndWordsStateWhatWasDone) {
  const std::string said = succeed("r.json -o even.ply --resolution 64 --even --summary s.json");
  const Json summary = json("s.json"), &even = summary["even"];
  EXPECT_GT(even["quality_after"]["first_percentile"], 0.5);
  EXPECT_GT(even["quality_after"]["mean"], even["quality_before"]["mean"]);
  EXPECT_LT(even["quality_before"]["first_percentile"], 0.1);
  EXPECT_GT(even["mean_move"], 0.1 * summary["cell"].get<double>());
  EXPECT_GT(even["largest_move"], even["mean_move"]);
  EXPECT_LT(even["largest_move"], 2.0 * summary["cell"].get<double>());
  EXPECT_LT(even["largest_value"], 0.04 * summary["cell"].get<double>());
  EXPECT_EQ(even["moved_vertices"].get<int>() + even["kept_vertices"].get<int>(), summary["vertices"]);
  EXPECT_TRUE(summary["closed"] && summary["manifold"]);
  EXPECT_NE(said.find("even: quality 0."), std::string::npos) << said;
  EXPECT_NE(said.find(" km in the mean"), std::string::npos) << said;
  EXPECT_TRUE(analyze_topology(read_mesh(folder_ / "even.ply")).closed);
}

TEST_F(SynthEven, SameBytesForAnyThreadsAndTheSameTrianglesAsWithout) {
  const std::string one = synthesise("a.ply", "--even --threads 1");
  EXPECT_EQ(synthesise("b.ply", "--even --threads 2"), one);
  EXPECT_EQ(synthesise("c.ply", "--even --threads 5"), one);
  EXPECT_NE(synthesise("plain.ply"), one);
  EXPECT_EQ(read_mesh(folder_ / "a.ply").triangles, read_mesh(folder_ / "plain.ply").triangles);
}

TEST_F(SynthEven, OtherFormatsAndOptionsHaveIt) {
  synthesise("even.obj", "--even");
  synthesise("even.glb", "--even");
  synthesise("even.ply.zst", "--even --min-component 0.001");
  synthesise("labels.ply", "--even --labels");
  synthesise("patch.ply", "--even --patch -1 0 0 0.5");
  const Json predicted = figures("r.json --predict --resolution 256 --even")["predicted"];
  const Json plain = figures("r.json --predict --resolution 256")["predicted"];
  EXPECT_GT(predicted["peak_bytes"], plain["peak_bytes"]);
}

TEST_F(SynthEven, TilesStillJoin) {
  for (const std::string tile : {"1", "2", "3"}) {
    const std::string even = tile != "2" ? " --even" : "";  // a plain tile fits even ones
    synthesise("tile_" + tile + ".ply", "--tile " + tile + "/3 --summary tile_" + tile + ".json" + even);
  }
  const testing::Outcome checked = testing::run_program(
      ASTROLITH_CHECK_TILES, {"tile_1.json", "tile_2.json", "tile_3.json"}, folder_.path());
  EXPECT_EQ(checked.status, 0) << checked.errors;
}

TEST_F(SynthEven, WhatCannotHaveItIsRefused) {
  refuse("r.json -o m.icq --resolution 16 --even", "leave out --even");
  refuse("r.json -o t.png --texture 64x64 --even", "--even");
}

}  // namespace
}  // namespace astrolith
