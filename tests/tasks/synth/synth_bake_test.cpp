#include <cmath>
#include <nlohmann/json.hpp>

#include "geometry/io/mesh_io.h"
#include "synthesis/picture/image_file.h"
#include "tests/tasks/synth/synth_runner.h"

namespace astrolith {
namespace {

using testing::has;

using SynthBake = SynthTest;

nlohmann::json glb_document(const std::string& glb) {
  return nlohmann::json::parse(glb.substr(20, glb.find(std::string("BIN\0", 4)) - 24));
}

TEST_F(SynthBake, WritesMapsAndMaterialsOfEachLevel) {
  const auto summary = figures("r.json -o out.glb --resolution 32 --uv charts --bake 256 --lod 2");
  ASSERT_EQ(summary["maps"].size(), 2u);
  EXPECT_EQ(summary["maps"][0]["side"], 256);
  EXPECT_EQ(summary["maps"][1]["side"], 128);
  EXPECT_LE(summary["charts"][0]["stretch_p99"], 2.0);
  EXPECT_EQ(summary["charts"][0]["padding"], 4);
  for (const char* word : {"normal", "height", "occlusion", "curvature", "label"}) {
    EXPECT_EQ(summary["maps"][1]["files"][word], std::string("out_lod1_") + word + ".png");
    EXPECT_EQ(text(std::string("out_") + word + ".png").substr(1, 3), "PNG");
  }
  const std::string glb = text("out.glb");
  const auto document = glb_document(glb);
  ASSERT_EQ(document["materials"].size(), 2u);
  EXPECT_EQ(document["images"].size(), 4u);
  EXPECT_EQ(document["images"][2]["name"], "out_lod1_normal");
  for (std::size_t level = 0; level < 2; ++level) {
    const auto& primitive = document["meshes"][level]["primitives"][0];
    EXPECT_EQ(primitive["material"], level);
    EXPECT_TRUE(primitive["attributes"].contains("TANGENT"));
    const auto& material = document["materials"][level];
    const std::size_t number = material["normalTexture"]["index"];
    const auto& view = document["bufferViews"][document["images"][number]["bufferView"].get<std::size_t>()];
    const std::size_t begin = glb.find(std::string("BIN\0", 4)) + 4 + view["byteOffset"].get<std::size_t>();
    EXPECT_TRUE(glb.substr(begin, view["byteLength"]) ==
                text(level == 0 ? "out_normal.png" : "out_lod1_normal.png"));
    EXPECT_TRUE(material.contains("occlusionTexture"));
  }
}

// An .obj names the material beside it, and the material the maps that are there.
TEST_F(SynthBake, ObjHasItsMaterial) {
  const auto summary = figures("r.json -o out.obj --resolution 32 --uv charts --bake 128 --lod 2");
  EXPECT_EQ(summary["maps"][1]["files"]["material"], "out_lod1.mtl");
  for (const std::string name : {"out", "out_lod1"}) {
    EXPECT_TRUE(has(text(name + ".obj"), "\nmtllib " + name + ".mtl\nusemtl regolith\nf ")) << name;
    const std::string material = text(name + ".mtl");
    EXPECT_TRUE(material.starts_with("newmtl regolith\n"));
    EXPECT_TRUE(has(material, "\nmap_Ka " + name + "_occlusion.png\n"));
    EXPECT_TRUE(has(material, "\nnorm " + name + "_normal.png\n"));
    EXPECT_FALSE(has(material, "map_Kd"));  // no layer paints
  }
  synthesise("plain.obj", "--uv charts");
  EXPECT_FALSE(has(text("plain.obj"), "mtllib") || std::filesystem::exists(folder_ / "plain.mtl"));
  // An input is no output.
  std::filesystem::copy_file(folder_ / "r.json", folder_ / "own.mtl",
                             std::filesystem::copy_options::overwrite_existing);
  refuse("own.mtl -o own.obj --uv charts --bake 128", "own.mtl");
}

// The coarsest mesh with its maps looks more like the finest one than it does without them.
TEST_F(SynthBake, SheetShowsWhatMapsDo) {
  write("hills.json", R"({"format_version": 1, "length_unit": "m",
    "body": {"type": "metaballs", "spheres": [[0, 0, 0, 1]]},
    "layers": [{"type": "simplex", "amplitude": 0.02, "frequency": 3, "octaves": 1}]})");
  succeed("hills.json -o out.glb --resolution 128 --uv charts --bake 1024 --lod 4 --sheet sheet.png");
  const std::string png = text("sheet.png");
  const GreyPng sheet = decode_grey_png({png.begin(), png.end()}, "sheet.png", 1, 1 << 14);
  EXPECT_EQ(sheet.width, 7 * 256);
  EXPECT_EQ(sheet.height, 24 + 256);
  const auto difference = [&](int column) {
    double sum = 0.0;
    for (int y = 24; y < sheet.height; ++y) {
      for (int x = 0; x < 256; ++x) {
        const auto at = [&](int panel) {
          return double(sheet.values[static_cast<std::size_t>(y * sheet.width + panel * 256 + x)]);
        };
        sum += std::abs(at(column) - at(0));
      }
    }
    return sum;
  };
  EXPECT_LT(difference(2), 0.6 * difference(1));
  refuse("r.json -o out.glb --sheet sheet.png", "--sheet requires --bake");
}

TEST_F(SynthBake, HasTheSameBytesForThreads) {
  const std::string one = synthesise("a.glb", "--uv charts --bake 128 --threads 1");
  EXPECT_TRUE(one == synthesise("a.glb", "--uv charts --bake 128 --threads 2"));
}

TEST_F(SynthBake, UvWithoutAWordIsByLongitude) {
  succeed("--uv r.json -o a.glb --resolution 32");
  EXPECT_TRUE(text("a.glb") == synthesise("b.glb", "--uv longitude"));
  EXPECT_FALSE(text("a.glb") == synthesise("b.glb", "--uv charts"));
}

// An .obj keeps its vertices, whose corners have coordinates of their own in each chart.
TEST_F(SynthBake, ObjHasTextureCoordinates) {
  synthesise("plain.obj");
  const std::string obj = synthesise("charts.obj", "--uv charts");
  EXPECT_NE(obj.find("\nvt "), obj.npos);
  const TriangleMesh plain = read_mesh(folder_ / "plain.obj"), charts = read_mesh(folder_ / "charts.obj");
  EXPECT_TRUE(plain.triangles == charts.triangles);
  EXPECT_TRUE(plain.vertices == charts.vertices);
}

TEST_F(SynthBake, ThatCannotBeIsRefused) {
  refuse("r.json -o a.glb --bake 256", "--bake requires --uv");
  refuse("r.json -o a.glb --uv --bake 256", "add --uv charts");
  refuse("r.json -o a.glb --uv charts --bake 0", "--bake: must be a number between 64 and 16384, is 0");
  refuse("r.json -o a.glb --uv charts --bake 1000000", "--bake: must be");
  refuse("r.json -o a.ply --uv charts", ".obj or .glb");
  refuse("r.json -o a.glb --uv charts --bake 256 --tile 1/2", "--bake excludes --tile");
  refuse("r.json -o a.glb --uv charts --bake 256 --patch 0 0 1 0.5", "--bake excludes --patch");
}

}  // namespace
}  // namespace astrolith
