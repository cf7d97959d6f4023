// synth, run as a user runs it: tiles, patches and height maps.
#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>

#include "geometry/io/mesh_io.h"
#include "tests/apps/synth_runner.h"

namespace astrolith {
namespace {

using testing::expect_refusal;
using testing::run_program;
using testing::text_of;

using SynthRegion = SynthTest;

TEST_F(SynthRegion, HeightMapOfAPatch) {
  const std::string ball = folder_.write("ball.json", R"({"format_version": 1, "length_unit": "km",
    "body": {"type": "metaballs", "spheres": [[0, 0, 0, 1]]}})");
  const std::string map = (folder_ / "h.tif").string();
  const testing::Outcome outcome =
      run_program(kSynth, {ball, "-o", (folder_ / "p.ply").string(), "--patch", "0", "0.6", "0.8", "0.1",
                           "--resolution", "32", "--height-map", map});
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const auto frame = nlohmann::json::parse(text_of(folder_ / "h.json"));
  EXPECT_EQ(frame["pixels"], 32);
  EXPECT_NEAR(frame["metres_per_pixel"].get<double>(), 100.0 / 32, 1e-9);
  EXPECT_NEAR(frame["up"][1].get<double>(), 0.6, 5e-3);
  EXPECT_NEAR(frame["up"][2].get<double>(), 0.8, 5e-3);
  // A reader after TIFF 6.0 and GeoTIFF 1.1: the directory's entries are 12 bytes each.
  const std::string bytes = text_of(map);
  const auto number = [&](std::size_t at, int count) {
    std::uint64_t value = 0;
    for (int k = count - 1; k >= 0; --k)
      value = value << 8 | static_cast<unsigned char>(bytes.at(at + static_cast<std::size_t>(k)));
    return value;
  };
  const auto real = [&](std::size_t at) {
    double value = 0;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
  };
  ASSERT_EQ(bytes.substr(0, 4), std::string("II*\0", 4));
  const std::size_t directory = number(4, 4);
  std::map<std::uint64_t, std::size_t> entries;
  for (std::size_t k = 0; k < number(directory, 2); ++k)
    entries[number(directory + 2 + 12 * k, 2)] = directory + 2 + 12 * k;
  EXPECT_EQ(number(entries.at(256) + 8, 2), 32u);
  EXPECT_EQ(number(entries.at(258) + 8, 2), 32u);
  EXPECT_EQ(number(entries.at(339) + 8, 2), 3u);  // floats
  EXPECT_NEAR(real(number(entries.at(33550) + 8, 4)), 100.0 / 32, 1e-9);
  EXPECT_NEAR(real(number(entries.at(33922) + 8, 4) + 24), -50.0, 1e-9);
  EXPECT_NEAR(real(number(entries.at(33922) + 8, 4) + 32), 50.0, 1e-9);
  EXPECT_EQ(bytes.substr(entries.at(42113) + 8, 3), "nan");
  // The pixel beside the middle lies 1 km from the ball's centre.
  float height = 0;
  const std::size_t strip = entries.at(273), strips = number(strip + 4, 4);
  const std::size_t first = strips == 1 ? number(strip + 8, 4) : number(number(strip + 8, 4), 4);
  std::memcpy(&height, bytes.data() + first + 4 * (16 * 32 + 16), sizeof height);
  double square = 0;
  for (int k = 0; k < 3; ++k) {
    const auto axis = [&](const char* name) {
      return frame[name][static_cast<std::size_t>(k)].get<double>();
    };
    const double p =
        axis("origin_m") + 0.5 * 3.125 * (axis("right") - axis("ahead")) + double{height} * axis("up");
    square += p * p;
  }
  EXPECT_NEAR(std::sqrt(square), 1000.0, 0.1);
  expect_refusal(folder_, kSynth,
                 {ball, "-o", (folder_ / "q.ply").string(), "--resolution", "32", "--height-map", map},
                 "--height-map");
}

TEST_F(SynthRegion, TilesMakeTheWholeMesh) {
  synthesise("whole.ply", {});
  std::size_t triangles = 0;
  for (const char* tile : {"1/3", "2/3", "3/3"}) {
    synthesise("tile.ply", {"--tile", tile});
    triangles += read_mesh(folder_ / "tile.ply").triangles.size();
  }
  EXPECT_EQ(triangles, read_mesh(folder_ / "whole.ply").triangles.size());
  const std::string recipe = folder_.write("r.json", kTwoSpheres);
  for (const char* tile : {"0/3", "4/3", "1/0", "1/300", "2", "1/3x"}) {
    expect_refusal(folder_, kSynth,
                   {recipe, "-o", (folder_ / "out.ply").string(), "--resolution", "32", "--tile", tile},
                   "tile");
  }
}

TEST_F(SynthRegion, PatchesAreOpenAndStateTheirOrigin) {
  const std::string summary = (folder_ / "s.json").string();
  const std::string bytes =
      synthesise("patch.ply", {"--patch", "-1.05", "0", "0.125", "0.3", "--summary", summary});
  EXPECT_NE(bytes.find("comment origin, to be added to all coordinates: -1.05 0 0.125\n"), std::string::npos);
  const auto figures = nlohmann::json::parse(text_of(summary));
  EXPECT_FALSE(figures.at("closed").get<bool>());
  EXPECT_EQ(figures.at("origin"), nlohmann::json({-1.05, 0.0, 0.125}));
  EXPECT_NEAR(figures.at("cell").get<double>(), 0.3 / 32, 1e-12);
  const Box box = read_mesh(folder_ / "patch.ply").bounds();
  EXPECT_LE(box.max.x, 0.1501);
  EXPECT_GE(box.min.y, -0.1501);
  EXPECT_GT(box.extent().y, 0.299);
  EXPECT_NE(synthesise("patch.glb", {"--patch", "-1.05", "0", "0.125", "0.3"}).find("\"origin\":[-1.05,0"),
            std::string::npos);
}

TEST_F(SynthRegion, PatchesWithoutSurfaceSayWhereThereIsSome) {
  const std::string recipe = folder_.write("r.json", kTwoSpheres);
  const auto refuse = [&](std::vector<std::string> patch, const std::string& culprit) {
    std::vector<std::string> arguments{
        recipe, "-o", (folder_ / "x.ply").string(), "--resolution", "16", "--device", "cpu", "--patch"};
    arguments.insert(arguments.end(), patch.begin(), patch.end());
    expect_refusal(folder_, kSynth, arguments, culprit);
  };
  refuse({"-1.5", "0", "0", "0.1"}, "there is some near -");
  refuse({"-1000", "0", "0", "0.1"}, "there is some near -1.");  // where the field is flat
  refuse({"-1", "0", "0", "0"}, "--patch: has no centre or no side");
  refuse({"-1", "0", "0"}, "--patch");
  refuse({"-1", "0", "0", "0.1", "--tile", "1/2"}, "--tile");
}

// A ball of 17 km under grains of millimetres: the whole mesh names the layer that it leaves out, and a patch
// has it.
TEST_F(SynthRegion, LayersLeftOutAreNamed) {
  const std::string recipe = folder_.write("big.json", R"({"format_version": 1, "length_unit": "m",
    "body": {"type": "metaballs", "spheres": [[0, 0, 0, 8500]]},
    "layers": [{"type": "gabor", "name": "grains", "pixel_size": 0.004, "height_rms": 0.004,
                "lobes": [[1, 0.2, 0.1, 1], [10, 0.01, 0, 3]]}]})");
  const std::string summary = (folder_ / "s.json").string(), out = (folder_ / "out.ply").string();
  const auto run = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments{recipe,     "-o",  out,         "--resolution", "32",
                                       "--device", "cpu", "--summary", summary};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const testing::Outcome outcome = run_program(kSynth, arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return outcome.errors;
  };
  const std::string said = run({});
  EXPECT_NE(said.find("layers[0] \"grains\" (gabor, 25 % of its variance); a --patch shows it"),
            std::string::npos)
      << said;
  const auto whole = nlohmann::json::parse(text_of(summary)).at("layers_left_out");
  ASSERT_EQ(whole.size(), 1u);
  EXPECT_EQ(whole[0].at("layer"), 0);
  EXPECT_EQ(whole[0].at("name"), "grains");
  EXPECT_EQ(whole[0].at("type"), "gabor");
  EXPECT_NEAR(whole[0].at("variance_share").get<double>(), 0.25, 1e-6);
  EXPECT_EQ(run({"--patch", "8500", "0", "0", "0.5"}).find("left out"), std::string::npos);
  EXPECT_TRUE(nlohmann::json::parse(text_of(summary)).at("layers_left_out").empty());
}

// Half a metre of a ball of 17 km, whose normal is along x there: heights have a standard deviation of 4 mm.
TEST_F(SynthRegion, APatchOfALargeBodyKeepsFineLayers) {
  const std::string recipe = folder_.write("big.json", R"({"format_version": 1, "length_unit": "m",
    "body": {"type": "metaballs", "spheres": [[0, 0, 0, 8500]]},
    "layers": [{"type": "gabor", "pixel_size": 0.004, "height_rms": 0.004, "lobes": [[3, -0.05, 0.1, 1]]}]})");
  const std::string out = (folder_ / "out.ply").string();
  const testing::Outcome outcome = run_program(kSynth, {recipe, "-o", out, "--resolution", "96", "--device",
                                                        "cpu", "--patch", "8500", "0", "0", "0.5"});
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  double squares = 0.0, sum = 0.0;
  const TriangleMesh mesh = read_mesh(out);
  for (const Vec3d& p : mesh.vertices) {
    sum += p.x;
    squares += p.x * p.x;
  }
  const double n = static_cast<double>(mesh.vertices.size());
  EXPECT_NEAR(std::sqrt(squares / n - sum * sum / (n * n)), 0.004, 0.001);
}

}  // namespace
}  // namespace astrolith
