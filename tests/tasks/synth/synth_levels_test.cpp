#include <nlohmann/json.hpp>

#include "geometry/io/mesh_io.h"
#include "geometry/surface/surface_distance.h"
#include "tests/tasks/synth/synth_runner.h"

namespace astrolith {
namespace {

using SynthLevels = SynthTest;

TEST_F(SynthLevels, AreFilesWhoseErrorsHold) {
  const auto summary = figures("r.json -o out.ply --resolution 64 --lod 3");
  const TriangleMesh finest = read_mesh(folder_ / "out.ply");
  ASSERT_EQ(summary["levels"].size(), 3u);
  std::size_t triangles = finest.triangles.size();
  for (const char* name : {"out_lod1.ply", "out_lod2.ply"}) {
    const auto& level = summary["levels"][name[7] - '0'];
    const TriangleMesh mesh = read_mesh(folder_ / name);
    EXPECT_EQ(level["file"], name);
    EXPECT_EQ(level["triangles"], mesh.triangles.size());
    EXPECT_NEAR(static_cast<double>(triangles) / static_cast<double>(mesh.triangles.size()), 4.0, 0.5);
    EXPECT_NEAR(level["mean_error"], surface_distance(finest, mesh, 20000, 7).mean,
                0.05 * level["mean_error"].get<double>());
    triangles = mesh.triangles.size();
  }
}

TEST_F(SynthLevels, StandInOneGlb) {
  const std::string glb = synthesise("out.glb", "--lod 3");
  const auto document = nlohmann::json::parse(glb.substr(20, glb.find(std::string("BIN\0", 4)) - 24));
  EXPECT_EQ(document["extensionsUsed"], nlohmann::json({"MSFT_lod"}));
  EXPECT_EQ(document["nodes"][0]["extensions"]["MSFT_lod"]["ids"], nlohmann::json({1, 2}));
  const auto& coverage = document["nodes"][0]["extras"]["MSFT_screencoverage"];
  ASSERT_EQ(coverage.size(), 3u);
  EXPECT_TRUE(coverage[0] > coverage[1] && coverage[1] > coverage[2]);
  EXPECT_EQ(document["meshes"].size(), 3u);
  for (const auto& node : document["nodes"]) EXPECT_EQ(node["rotation"], document["nodes"][0]["rotation"]);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out_lod1.glb"));
  EXPECT_TRUE(glb == synthesise("again.glb", "--lod 3 --threads 1"));
}

TEST_F(SynthLevels, ThatCannotBeAreRefused) {
  refuse("r.json -o out.ply --resolution 16 --lod 5", "--lod: level 4 would have");
  refuse("r.json -o out.ply --lod 2 --points", "--lod");
}

}  // namespace
}  // namespace astrolith
