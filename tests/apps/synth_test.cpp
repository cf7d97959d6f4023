// synth, run as a user runs it.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>

#include "apps/memory_use.h"
#include "geometry/io/mesh_io.h"
#include "geometry/mesh_topology.h"
#include "recipe/sha256.h"
#include "tests/apps/program_runner.h"

namespace astrolith {
namespace {

using testing::expect_refusal;
using testing::run_program;
using testing::text_of;
using testing::WorkFolder;

const std::string kSynth = ASTROLITH_SYNTH;

const std::string kTwoSpheres = R"({"format_version": 1, "length_unit": "km",
  "body": {"type": "metaballs", "spheres": [[0, 0, 0, 1], [1, 0, 0, 0.75]]},
  "layers": [{"type": "simplex", "amplitude": 0.05, "frequency": 2, "octaves": 4}]})";

const std::string kTexture = R"({"format_version": 1, "length_unit": "m",
  "layers": [{"type": "gabor", "pixel_size": 0.01, "height_rms": 0.002, "lobes": [[4, 0.125, -0.25, 1]]}]})";

const std::string kDrawnCraters = R"({"format_version": 1, "length_unit": "m",
  "body": {"type": "metaballs", "spheres": [[0, 0, 0, 100]]},
  "layers": [{"type": "simplex", "amplitude": 3, "frequency": 0.02, "octaves": 3},
    {"type": "craters", "population": {"count": 2000, "exponent": 1.7, "least_diameter": 6, "greatest_diameter": 60}}]})";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

class Synth : public ::testing::Test {
 protected:
  // Runs with --resolution 32 and returns the bytes of the output.
  std::string synthesise(const std::string& output, std::vector<std::string> more) {
    const std::string file = (folder_ / output).string();
    std::vector<std::string> arguments{folder_.write("r.json", kTwoSpheres), "-o", file, "--resolution",
                                       "32"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const testing::Outcome outcome = run_program(kSynth, arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return text_of(file);
  }
  void expect_recipe_refused(const std::string& recipe, const std::string& culprit) {
    const std::string file = folder_.write("bad.json", recipe);
    expect_refusal(folder_, kSynth, {file, "-o", (folder_ / "out.ply").string(), "--resolution", "16"},
                   "bad.json: " + culprit);
  }

  WorkFolder folder_;
};

// The C library has other code, with other last bits, for processors without fma. Its tunables choose that
// code here.
TEST_F(Synth, TheCLibrarysCodeForTheProcessorChangesNothing) {
  const std::string recipe = folder_.write("r.json", kDrawnCraters), ply = (folder_ / "mesh.ply").string(),
                    list = (folder_ / "list.csv").string();
  const auto run = [&](const std::string& tunables, std::vector<std::string> more) {
    more.insert(more.begin(), {recipe, "-o", ply, "--resolution", "32"});
    ::setenv("GLIBC_TUNABLES", tunables.c_str(), 1);
    const testing::Outcome outcome = run_program(kSynth, more);
    ::unsetenv("GLIBC_TUNABLES");
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return text_of(ply) + text_of(list);
  };
  const std::vector<std::vector<std::string>> requests{
      {"--feature-list", list}, {"--patch", "100", "0", "0", "20"}, {"--vary", "0.2", "--seed", "3"}};
  for (const std::vector<std::string>& more : requests) {
    EXPECT_EQ(run("", more), run("glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4", more)) << more.front();
  }
}

// The recipe's Gabor or fractal layers, by a GPU or without one.
TEST_F(Synth, TheDeviceChangesNothing) {
  const std::string by_cpu = synthesise("cpu.ply", {"--device", "cpu"});
  EXPECT_EQ(synthesise("auto.ply", {"--device", "auto"}), by_cpu);
  const std::string out = (folder_ / "cuda.ply").string();
  const testing::Outcome chosen = run_program(
      kSynth, {folder_.write("r.json", kTwoSpheres), "-o", out, "--resolution", "16", "--device", "auto"});
  EXPECT_NE(chosen.errors.find("; computed on "), std::string::npos) << chosen.errors;
  const testing::Outcome outcome = run_program(
      kSynth, {folder_.write("r.json", kTwoSpheres), "-o", out, "--resolution", "32", "--device", "cuda"});
  if (outcome.status == 0) {
    EXPECT_EQ(text_of(out), by_cpu);
  } else {
    EXPECT_EQ(outcome.status, 2);
    EXPECT_NE(outcome.errors.find("--device cuda: "), std::string::npos) << outcome.errors;
  }
}

TEST_F(Synth, FeaturesAreListedAsDrawn) {
  const std::string craters = replaced(kTwoSpheres, "\"layers\": [", R"("layers": [{"type": "craters",
    "craters": [{"direction": [0, 0, 1], "diameter": 0.5, "age": 9}], "complex_from": 0.4,
    "population": {"count": 20, "least_diameter": 0.05, "greatest_diameter": 0.3}},
    {"type": "boulders", "boulders": [{"direction": [0, 1, 0], "axes": [0.3, 0.2, 0.1]}]}, )");
  const std::string file = folder_.write("c.json", craters), csv = (folder_ / "f.csv").string(),
                    json = (folder_ / "f.json").string();
  for (const std::string& list : {csv, json}) {
    const testing::Outcome outcome = run_program(
        kSynth, {file, "-o", (folder_ / "c.ply").string(), "--resolution", "24", "--feature-list", list});
    ASSERT_EQ(outcome.status, 0) << outcome.errors;
  }
  const auto document = nlohmann::json::parse(text_of(json));
  EXPECT_EQ(document["length_unit"], "km");
  ASSERT_EQ(document["features"].size(), 22u);
  EXPECT_EQ(document["features"][21]["kind"], "boulder");
  EXPECT_EQ(document["features"][21]["axis_b"], 0.2);
  EXPECT_FALSE(document["features"][21].contains("depth"));
  EXPECT_EQ(document["features"][0]["kind"], "complex crater");  // the oldest
  EXPECT_EQ(document["features"][0]["depth"], 0.03);
  const std::string text = text_of(csv);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 23);
  EXPECT_EQ(text.rfind("layer,kind,x,y,z,mesh_x,mesh_y,mesh_z,center_x,", 0), 0u) << text;
  expect_recipe_refused(replaced(craters, "\"diameter\": 0.5", "\"diameter\": 50"),
                        "layers[0].craters[0].diameter: is 50");
}

TEST_F(Synth, MeshIsClosedAndManifold) {
  synthesise("out.ply", {});
  const MeshTopology topology = analyze_topology(read_mesh(folder_ / "out.ply"));
  EXPECT_TRUE(topology.closed);
  EXPECT_TRUE(topology.manifold);
  EXPECT_EQ(topology.components, 1);
}

TEST_F(Synth, GravityComesWithTheMesh) {
  const std::string summary = (folder_ / "s.json").string();
  const std::string plain = synthesise("plain.ply", {});
  const std::string text = synthesise("g.ply", {"--gravity", "2000", "6", "--summary", summary});
  for (const char* name : {"potential_J_kg", "geopotential_J_kg", "slope_deg", "elevation_m"}) {
    EXPECT_NE(text.find(std::string("property float ") + name + "\n"), std::string::npos) << name;
  }
  const TriangleMesh mesh = read_mesh(folder_ / "g.ply"), same = read_mesh(folder_ / "plain.ply");
  EXPECT_TRUE(mesh.vertices == same.vertices);
  EXPECT_TRUE(mesh.triangles == same.triangles);
  const auto gravity = nlohmann::json::parse(text_of(summary))["gravity"];
  // Two balls of 1 and 0.75 km: U at the surface is about G M / r.
  EXPECT_NEAR(gravity["potential_J_kg"]["mean"].get<double>(), -0.65, 0.15);
  EXPECT_GT(gravity["slope_deg"]["max"].get<double>(), 10.0);
  EXPECT_LE(gravity["achieved_error"]["largest"].get<double>(), 1e-6);
  EXPECT_EQ(synthesise("one.ply", {"--gravity", "2000", "6", "--threads", "1"}), text);
}

TEST_F(Synth, GravityThatMakesNoSenseIsRefused) {
  const std::string recipe = folder_.write("r.json", kTwoSpheres);
  const auto refuse = [&](const std::string& output, std::vector<std::string> more,
                          const std::string& culprit) {
    std::vector<std::string> arguments{recipe, "-o", (folder_ / output).string(), "--resolution", "16"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    expect_refusal(folder_, kSynth, arguments, culprit);
  };
  refuse("a.ply", {"--gravity", "0", "6"}, "--gravity: the density");
  refuse("a.ply", {"--gravity", "2000", "-1"}, "--gravity: the period");
  refuse("a.ply", {"--gravity", "2000", "6", "--points"}, "--gravity: is of the whole");
  refuse("a.ply", {"--gravity", "2000", "6", "--tile", "1/2"}, "--gravity: is of the whole");
  refuse("a.obj", {"--gravity", "2000", "6"}, "a.obj");
}

TEST_F(Synth, HeightMapOfAPatch) {
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

TEST_F(Synth, WritesIcqAndPlates) {
  synthesise("a.tab", {});
  EXPECT_TRUE(analyze_topology(read_mesh(folder_ / "a.tab")).closed);
  const std::string ball = folder_.write("ball.json", R"({"format_version": 1, "length_unit": "km",
    "body": {"type": "metaballs", "spheres": [[0, 0, 0, 1]]}})");
  const std::string icq = (folder_ / "a.icq").string();
  ASSERT_EQ(run_program(kSynth, {ball, "-o", icq, "--resolution", "32"}).status, 0);
  EXPECT_TRUE(analyze_topology(read_mesh(icq)).closed);
  const std::string apart = folder_.write("apart.json", R"({"format_version": 1, "length_unit": "km",
    "body": {"type": "metaballs", "spheres": [[0, 0, 0, 1], [9, 0, 0, 1]]}})");
  expect_refusal(folder_, kSynth, {apart, "-o", (folder_ / "b.icq").string(), "--resolution", "32"}, "b.icq");
}

TEST_F(Synth, ABodyThatTheIsoValueErasesIsAnInputError) {
  expect_recipe_refused(replaced(kTwoSpheres, "\"spheres\"", "\"iso_value\": 100, \"spheres\""),
                        "body.iso_value");
}

TEST_F(Synth, EveryFormatHoldsTheSameMesh) {
  synthesise("out.ply", {});
  const TriangleMesh ply = read_mesh(folder_ / "out.ply");
  for (const char* name : {"out.obj", "out.stl"}) {
    synthesise(name, {});
    EXPECT_EQ(read_mesh(folder_ / name).triangles.size(), ply.triangles.size()) << name;
  }
  EXPECT_EQ(synthesise("out.glb", {}).substr(0, 4), "glTF");
}

TEST_F(Synth, SameBytesForAnyThreadCount) {
  const std::string one = synthesise("one.ply", {"--threads", "1"});
  EXPECT_GT(one.size(), 10000u);
  EXPECT_TRUE(one == synthesise("two.ply", {"--threads", "2"}));
  EXPECT_TRUE(one == synthesise("eight.ply", {"--threads", "8"}));
}

TEST_F(Synth, VariationsAreAsAlikeAsAskedAndStayInOnePiece) {
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
TEST_F(Synth, AVariationThatWouldBeTheSameBodyIsRefused) {
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

TEST_F(Synth, VariationsCanBeLikeATargetInstead) {
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

TEST_F(Synth, HeightsBeyondAllMeasureAreRefusedByName) {
  expect_recipe_refused(replaced(kTwoSpheres, "0.05", "1e9"), "layers[0].amplitude: heights of up to");
}

// An intersection with a joint of 100 km lowers the whole surface of a body of 2 km by 50 km.
TEST_F(Synth, ALayerThatTakesTheBodyAwayIsNamed) {
  const std::string layers = R"("octaves": 4}, {"type": "simplex", "amplitude": 0.001, "frequency": 2,
    "combine": {"type": "blend", "operator": "intersection", "width": 100}}])";
  expect_recipe_refused(replaced(kTwoSpheres, R"("octaves": 4}])", layers),
                        "layers[1].combine.width: nothing of the body is left");
}

// U+202E would turn the rest of the line around, and U+2028 breaks it.
TEST_F(Synth, WhatARecipeQuotesIsEscaped) {
  expect_recipe_refused(replaced(kTwoSpheres, "simplex", "\u202esim\u2028plex\u009b"),
                        "layers[0].type: must be one of");
  const testing::Outcome outcome = run_program(
      kSynth, {folder_.write("\u202e\xff.json", replaced(kTwoSpheres, "simplex", "\u202e\u2028\u009b")), "-o",
               (folder_ / "out.ply").string()});
  for (const char* raw : {"\u202e", "\u2028", "\u009b", "\xff"}) {
    EXPECT_EQ(outcome.errors.find(raw), std::string::npos) << outcome.errors;
  }
  EXPECT_NE(outcome.errors.find(R"(\u202e\xff.json: layers[0].type)"), std::string::npos) << outcome.errors;
  EXPECT_NE(outcome.errors.find(R"(\u202e\u2028\u009b)"), std::string::npos) << outcome.errors;
}

TEST_F(Synth, SeedChangesTheMesh) {
  const std::string mesh = synthesise("a.ply", {"--seed", "5"});
  EXPECT_TRUE(mesh == synthesise("b.ply", {"--seed", "5"}));
  EXPECT_FALSE(mesh == synthesise("c.ply", {"--seed", "6"}));
}

TEST_F(Synth, SummaryHoldsTheFigures) {
  synthesise("out.ply", {"--summary", (folder_ / "s.json").string()});
  const auto summary = nlohmann::json::parse(text_of(folder_ / "s.json"));
  for (const char* field : {"vertices", "triangles", "closed", "manifold", "genus", "evaluations", "seconds",
                            "peak_bytes", "sha256"}) {
    EXPECT_TRUE(summary.contains(field)) << field;
  }
  const TriangleMesh mesh = read_mesh(folder_ / "out.ply");
  EXPECT_EQ(summary["vertices"], mesh.vertices.size());
  EXPECT_EQ(summary["triangles"], mesh.triangles.size());
  EXPECT_EQ(summary["closed"], true);
  EXPECT_EQ(summary["genus"], analyze_topology(mesh).genus);
  EXPECT_EQ(summary["sha256"], sha256_of_file(folder_ / "out.ply"));
}

TEST_F(Synth, TrianglesChooseTheResolutionAndMemoryIsKept) {
  const std::string recipe = folder_.write("r.json", kTwoSpheres);
  const std::string output = (folder_ / "out.obj").string(), summary = (folder_ / "s.json").string();
  const testing::Outcome outcome =
      run_program(kSynth, {recipe, "-o", output, "--triangles", "30000", "--summary", summary});
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  const auto figures = nlohmann::json::parse(text_of(summary));
  EXPECT_NEAR(figures["triangles"].get<double>(), 30e3, 3e3);
  EXPECT_NEAR(figures["predicted"]["triangles"].get<double>(), 30e3, 2e3);
  std::filesystem::remove(output);
  expect_refusal(folder_, kSynth, {recipe, "-o", output, "--resolution", "1024", "--max-memory", "0.1"},
                 "needs");
  expect_refusal(folder_, kSynth, {recipe, "-o", output, "--triangles", "1e10"}, "--triangles");
  expect_refusal(folder_, kSynth, {recipe, "-o", output, "--resolution", "64", "--triangles", "1000"},
                 "excludes");
}

// The whole mesh's file without its faces, but for the header.
TEST_F(Synth, PointsAreTheVerticesAlone) {
  const std::string mesh = synthesise("mesh.ply", {}), points = synthesise("points.ply", {"--points"});
  const auto body = [](const std::string& file) { return file.substr(file.find("end_header\n")); };
  EXPECT_NE(points.find("element face 0\n"), std::string::npos);
  EXPECT_GT(body(points).size(), 10000u);
  EXPECT_EQ(body(points), body(mesh).substr(0, body(points).size()));
  const std::string recipe = folder_.write("r.json", kTwoSpheres);
  expect_refusal(folder_, kSynth, {recipe, "-o", (folder_ / "out.obj").string(), "--points"}, ".ply");
}

TEST_F(Synth, LabelsStandBesideTheNormals) {
  const std::string bytes = synthesise("labels.ply", {"--labels"});
  EXPECT_NE(bytes.find("comment label 0: the bare body\ncomment label 1: simplex\n"), std::string::npos);
  EXPECT_NE(bytes.find("property float nz\nproperty int label\nproperty float elevation\n"),
            std::string::npos);
  synthesise("plain.ply", {});
  const TriangleMesh labelled = read_mesh(folder_ / "labels.ply"), plain = read_mesh(folder_ / "plain.ply");
  EXPECT_TRUE(labelled.vertices == plain.vertices && labelled.triangles == plain.triangles);
  EXPECT_NE(synthesise("points.ply", {"--labels", "--points"}).find("element face 0\n"), std::string::npos);
  const std::string recipe = folder_.write("r.json", kTwoSpheres);
  expect_refusal(folder_, kSynth, {recipe, "-o", (folder_ / "out.obj").string(), "--labels"}, ".ply");
}

TEST_F(Synth, TilesMakeTheWholeMesh) {
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

TEST_F(Synth, PatchesAreOpenAndStateTheirOrigin) {
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

TEST_F(Synth, PatchesWithoutSurfaceSayWhereThereIsSome) {
  const std::string recipe = folder_.write("r.json", kTwoSpheres);
  const auto refuse = [&](std::vector<std::string> patch, const std::string& culprit) {
    std::vector<std::string> arguments{
        recipe, "-o", (folder_ / "x.ply").string(), "--resolution", "16", "--device", "cpu", "--patch"};
    arguments.insert(arguments.end(), patch.begin(), patch.end());
    expect_refusal(folder_, kSynth, arguments, culprit);
  };
  refuse({"-1.5", "0", "0", "0.1"}, "there is some near -");
  refuse({"-1", "0", "0", "0"}, "--patch: has no centre or no side");
  refuse({"-1", "0", "0"}, "--patch");
  refuse({"-1", "0", "0", "0.1", "--tile", "1/2"}, "--tile");
}

// A ball of 17 km under grains of millimetres: the whole mesh names the layer that it leaves out, and a patch
// has it.
TEST_F(Synth, LayersLeftOutAreNamed) {
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
TEST_F(Synth, APatchOfALargeBodyKeepsFineLayers) {
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

TEST_F(Synth, SpotsThatTakeTooLongAreRefused) {
  expect_recipe_refused(R"({"format_version": 1, "length_unit": "m", "body": {"type": "metaballs",
    "spheres": [[0, 0, 0, 100]]}, "layers": [{"type": "spots", "amplitude": 0.5, "size": 40, "cell_size": 40,
    "density": 60, "layers": 12, "gain": 4}]})",
                        "layers[0].density: these spots");
}

TEST_F(Synth, GaborLayersThatTakeTooLongAreRefused) {
  std::string lobes;
  for (int bandwidth = 1; bandwidth <= 12; ++bandwidth)
    lobes += (bandwidth > 1 ? ", [" : "[") + std::to_string(bandwidth) + ", 0.1, 0.2, 1]";
  const auto recipe = [&](const std::string& impulses) {
    return R"({"format_version": 1, "length_unit": "m", "body": {"type": "metaballs", "spheres": [[0, 0, 0, 1]]},
      "layers": [{"type": "gabor", "pixel_size": 0.01, "height_rms": 0.01, "impulses_per_kernel": )" +
           impulses + R"(, "lobes": [)" + lobes + "]}]}";
  };
  expect_recipe_refused(recipe("1024"),
                        "layers[0].impulses_per_kernel: these impulses, with those of earlier "
                        "layers, take 520034");
  const testing::Outcome made = run_program(kSynth, {folder_.write("r.json", recipe("32")), "-o",
                                                     (folder_ / "m.ply").string(), "--resolution", "16"});
  EXPECT_EQ(made.status, 0) << made.errors;
}

TEST_F(Synth, PredictionWritesNothing) {
  const std::string summary = (folder_ / "s.json").string();
  const testing::Outcome outcome =
      run_program(kSynth, {folder_.write("r.json", kTwoSpheres), "-o", (folder_ / "x.ply").string(),
                           "--resolution", "64", "--predict", "--summary", summary});
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_NE(outcome.errors.find("triangles"), std::string::npos);
  EXPECT_EQ(folder_.files(), (std::set<std::string>{"r.json", "s.json"}));
  const auto predicted = nlohmann::json::parse(text_of(summary)).at("predicted");
  for (const char* figure : {"triangles", "file_bytes", "peak_bytes", "seconds"}) {
    EXPECT_GT(predicted.at(figure).get<double>(), 0.0) << figure;
  }
}

// A body with a Gabor layer of three bands, which masks a second layer.
const std::string kMaskedByGabor = R"({"format_version": 1, "length_unit": "m",
  "body": {"type": "metaballs", "spheres": [[0, 0, 0, 1], [1, 0, 0, 0.75]]},
  "layers": [{"type": "gabor", "name": "grain", "pixel_size": 0.01, "height_rms": 0.01,
              "lobes": [[2, 0.1, 0.1, 1], [3, 0.125, -0.25, 1], [4, 0.05, 0.02, 1]]},
             {"type": "simplex", "amplitude": 0.05, "frequency": 2,
              "mask": {"layer": "grain", "from": -0.01, "to": 0.01}}]})";

TEST_F(Synth, AMaskMayNameAGaborLayer) {
  const std::string recipe = folder_.write("masked.json", kMaskedByGabor);
  const std::string output = (folder_ / "out.ply").string();
  for (const char* size : {"--resolution", "--triangles"}) {
    const std::string value = size == std::string("--resolution") ? "24" : "3000";
    const testing::Outcome made = run_program(kSynth, {recipe, "-o", output, size, value});
    EXPECT_EQ(made.status, 0) << made.errors;
  }
  const testing::Outcome predicted =
      run_program(kSynth, {recipe, "-o", output, "--resolution", "24", "--predict"});
  EXPECT_EQ(predicted.status, 0) << predicted.errors;
}

TEST_F(Synth, MemoryStaysBelowWhatIsAllowed) {
  if (!kMemoryIsTheProgramsOwn) GTEST_SKIP() << "a sanitizer's memory is not predicted";
  const std::string recipe = folder_.write("masked.json", kMaskedByGabor);
  const std::string output = (folder_ / "out.ply").string(), summary = (folder_ / "s.json").string();
  int made = 0, refused = 0;
  for (const double gigabytes : {0.01, 0.03, 0.045, 0.06, 0.5}) {
    const testing::Outcome outcome =
        run_program(kSynth, {recipe, "-o", output, "--resolution", "64", "--threads", "2", "--max-memory",
                             std::to_string(gigabytes), "--summary", summary});
    if (outcome.status == 0) {
      ++made;
      EXPECT_LE(nlohmann::json::parse(text_of(summary)).at("peak_bytes").get<double>(), 1e9 * gigabytes);
    } else {
      ++refused;
      EXPECT_EQ(outcome.status, 2) << outcome.errors;
      EXPECT_NE(outcome.errors.find("GB"), std::string::npos) << outcome.errors;
      EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
    }
  }
  EXPECT_GE(made, 1);
  EXPECT_GE(refused, 1);
}

// Prediction looks at few blocks, so that it is far quicker than the mesh and not far from the truth.
TEST_F(Synth, PredictionMeetsTheMesh) {
  const std::string recipe = folder_.write("masked.json", kMaskedByGabor);
  const std::string output = (folder_ / "out.ply").string(), summary = (folder_ / "s.json").string();
  const auto figures = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments{recipe, "-o", output, "--resolution", "96", "--summary", summary};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run_program(kSynth, arguments).status, 0);
    return nlohmann::json::parse(text_of(summary));
  };
  const auto predicted = figures({"--predict"}), made = figures({});
  const auto& of_mesh = predicted.at("predicted");
  EXPECT_NEAR(of_mesh.at("triangles").get<double>() / made.at("triangles").get<double>(), 1.0, 0.3);
  if (!kMemoryIsTheProgramsOwn) return;
  EXPECT_LE(made.at("peak_bytes").get<double>(), 1.2 * of_mesh.at("peak_bytes").get<double>());
  EXPECT_GE(made.at("peak_bytes").get<double>(), 0.5 * of_mesh.at("peak_bytes").get<double>());
}

// Two spheres under a Gabor layer of one band.
std::string gabor_layer(double pixel_size, int impulses, const std::string& more) {
  return R"({"format_version": 1, "length_unit": "m",
    "body": {"type": "metaballs", "spheres": [[0, 0, 0, 1], [1, 0, 0, 0.75]]},
    "layers": [{"type": "gabor", "height_rms": 0.003, "lobes": [[3, 0.125, -0.25, 1]], "pixel_size": )" +
         std::to_string(pixel_size) + ", \"impulses_per_kernel\": " + std::to_string(impulses) + "}]" + more +
         "}";
}

// The lattice that finds the mass of the body is finer than the mesh. It draws tiles of impulses, of which
// the mesh has none.
TEST_F(Synth, MemoryOfErosionIsPredicted) {
  if (!kMemoryIsTheProgramsOwn) GTEST_SKIP() << "a sanitizer's memory is not predicted";
  const std::string recipe = folder_.write(
      "eroded.json", gabor_layer(0.007, 32, R"(, "erosion": {"talus_angle": 30, "iterations": 5})"));
  const std::string output = (folder_ / "out.ply").string(), summary = (folder_ / "s.json").string();
  const auto figures = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments{recipe,      "-o", output,      "--resolution", "20",
                                       "--threads", "1",  "--summary", summary};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run_program(kSynth, arguments).status, 0);
    return nlohmann::json::parse(text_of(summary));
  };
  const double predicted = figures({"--predict"}).at("predicted").at("peak_bytes").get<double>();
  EXPECT_LE(figures({}).at("peak_bytes").get<double>(), 1.2 * predicted);
}

// A block here needs tiles of 200 MB, many times what the cache keeps of them.
TEST_F(Synth, ThreadsHoldFewTilesOfImpulses) {
  if (!kMemoryIsTheProgramsOwn) GTEST_SKIP() << "a sanitizer has memory of its own";
  const std::string recipe = folder_.write("dense.json", gabor_layer(0.02, 400, "")),
                    summary = (folder_ / "s.json").string();
  const testing::Outcome made =
      run_program(kSynth, {recipe, "-o", (folder_ / "out.ply").string(), "--resolution", "12", "--threads",
                           "2", "--summary", summary});
  EXPECT_EQ(made.status, 0) << made.errors;
  EXPECT_LE(nlohmann::json::parse(text_of(summary)).at("peak_bytes").get<double>(), 120e6);
}

TEST_F(Synth, SmallPiecesAreLeftOut) {
  const std::string crumbs = replaced(kTwoSpheres, "[1, 0, 0, 0.75]", "[1, 0, 0, 0.75], [2.6, 0, 0, 0.15]");
  const std::string recipe = folder_.write("crumbs.json", crumbs), summary = (folder_ / "s.json").string();
  const auto components = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments{
        recipe, "-o", (folder_ / "x.ply").string(), "--resolution", "64", "--summary", summary};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run_program(kSynth, arguments).status, 0);
    return nlohmann::json::parse(text_of(summary)).at("components").get<int>();
  };
  EXPECT_EQ(components({}), 2);
  EXPECT_EQ(components({"--min-component", "0.01"}), 1);
  EXPECT_EQ(analyze_topology(read_mesh(folder_ / "x.ply")).components, 1);
}

TEST_F(Synth, ErosionSettlesAndIsOfTheWhole) {
  const std::string eroded =
      replaced(kTwoSpheres, "\"layers\"", "\"erosion\": {\"talus_angle\": 30}, \"layers\"");
  const std::string recipe = folder_.write("eroded.json", eroded), summary = (folder_ / "s.json").string();
  const auto bytes = [&](const std::string& threads) {
    const std::string file = (folder_ / "x.ply").string();
    const testing::Outcome outcome = run_program(
        kSynth, {recipe, "-o", file, "--resolution", "40", "--threads", threads, "--summary", summary});
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return text_of(file);
  };
  EXPECT_TRUE(bytes("1") == bytes("4"));
  const auto figures = nlohmann::json::parse(text_of(summary));
  EXPECT_TRUE(figures.at("closed").get<bool>());
  EXPECT_TRUE(figures.at("erosion").at("settled").get<bool>());
  EXPECT_LE(figures.at("erosion").at("steepest_after").get<double>(), 30.0);
  EXPECT_GT(figures.at("erosion").at("steepest_before").get<double>(), 31.0);
  expect_refusal(folder_, kSynth,
                 {recipe, "-o", (folder_ / "x.ply").string(), "--resolution", "40", "--tile", "1/2"},
                 "--tile");
}

TEST_F(Synth, PicturesCanBeTakenFromElsewhere) {
  const auto picture = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments{"--preview", (folder_ / "p.png").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    synthesise("out.ply", arguments);
    return text_of(folder_ / "p.png");
  };
  const std::string one = picture({"--view", "1", "0", "0"});
  EXPECT_FALSE(one == picture({"--view", "1", "0", "0", "--view", "0", "0", "1"}));
  EXPECT_FALSE(one == picture({"--view", "1", "0", "0", "--sun", "0", "0", "1"}));
  std::filesystem::remove(folder_ / "p.png");
  const std::string recipe = folder_.write("r.json", kTwoSpheres), out = (folder_ / "x.ply").string();
  expect_refusal(folder_, kSynth, {recipe, "-o", out, "--sun", "1", "0", "0"}, "--preview");
  expect_refusal(folder_, kSynth,
                 {recipe, "-o", out, "--preview", (folder_ / "p.png").string(), "--sun", "0", "0", "0"},
                 "--sun");
}

TEST_F(Synth, NoOutputIsTheInputOrAnotherOutput) {
  const std::string recipe = folder_.write("r.json", kTwoSpheres);
  const std::string output = (folder_ / "out.ply").string();
  expect_refusal(folder_, kSynth, {recipe, "-o", output, "--summary", recipe}, "is the input itself");
  expect_refusal(folder_, kSynth, {recipe, "-o", output, "--preview", recipe}, "is the input itself");
  expect_refusal(folder_, kSynth, {recipe, "-o", output, "--summary", output}, "two outputs");
  EXPECT_EQ(text_of(recipe), kTwoSpheres);
}

TEST_F(Synth, BadRecipesAreRefused) {
  expect_recipe_refused(replaced(kTwoSpheres, "amplitude", "amplitud"), "layers[0].amplitud: unknown field");
  expect_recipe_refused(replaced(kTwoSpheres, "0.75", "-0.75"), "body.spheres[1].radius");
  expect_recipe_refused(replaced(kTwoSpheres, "]]}", "]}"), "line 2, column");
  expect_recipe_refused(replaced(kTwoSpheres, "0.05", "NaN"), "line 3, column");
  expect_recipe_refused("", "is empty");
  expect_recipe_refused(kTexture, "");  // no body to mesh
}

TEST_F(Synth, AbsurdSizesAreRefused) {
  const auto with_layer = [](const std::string& layer) {
    return R"({"format_version": 1, "length_unit": "m", "body": {"type": "metaballs", "spheres": [[0, 0, 0, 100]]},
               "layers": [)" +
           layer + "]}";
  };
  expect_recipe_refused(
      with_layer(R"({"type": "craters", "craters": [{"direction": [0, 0, 1], "diameter": 900}]})"),
      "layers[0].craters[0].diameter: is 900");
  expect_recipe_refused(
      with_layer(R"({"type": "boulders", "boulders": [{"direction": [0, 0, 1], "axes": [900, 800, 700]}]})"),
      "layers[0].boulders[0].axes: is 900");
  expect_recipe_refused(
      with_layer(
          R"({"type": "craters", "population": {"density": 1e5, "least_diameter": 1, "greatest_diameter": 2}})"),
      "layers[0].population.density: would draw");
  expect_recipe_refused(with_layer(R"({"type": "spots", "density": 1e9})"),
                        "layers[0].density: must be at most");
  expect_recipe_refused(with_layer(R"({"type": "lava"})"), "layers[0].type: must be one of");
  const std::string recipe = folder_.write("r.json", kTwoSpheres);
  for (const char* resolution : {"0", "1000000"}) {
    expect_refusal(folder_, kSynth,
                   {recipe, "-o", (folder_ / "out.ply").string(), "--resolution", resolution},
                   "--resolution");
  }
}

TEST_F(Synth, BadFilesAreRefused) {
  const std::string recipe = folder_.write("r.json", kTwoSpheres);
  std::filesystem::create_directory(folder_ / "folder.ply");
  const auto refuse = [&](const std::string& input, const std::string& output, const std::string& culprit) {
    expect_refusal(folder_, kSynth, {input, "-o", output, "--resolution", "16"}, culprit);
  };
  refuse((folder_ / "absent.json").string(), (folder_ / "out.ply").string(), "absent.json");
  refuse(folder_.write("x.json", "\x89PNG\r\n\x1a\n"), (folder_ / "out.ply").string(), "x.json");
  refuse(recipe, (folder_ / "absent" / "out.ply").string(), "out.ply");
  refuse(recipe, (folder_ / "folder.ply").string(), "folder.ply");
  refuse(recipe, (folder_ / "out.xyz").string(), "out.xyz");
}

TEST_F(Synth, ReadOnlyFoldersAreRefused) {
  if (::geteuid() == 0) GTEST_SKIP() << "the superuser may write everywhere";
  const std::string recipe = folder_.write("r.json", kTwoSpheres);
  std::filesystem::create_directory(folder_ / "locked");
  std::filesystem::permissions(folder_ / "locked", std::filesystem::perms{0555});
  expect_refusal(folder_, kSynth, {recipe, "-o", (folder_ / "locked" / "out.ply").string()}, "out.ply");
}

TEST_F(Synth, ColouredLayersMakeAPicture) {
  const std::string recipe = folder_.write(
      "c.json",
      replaced(kTexture, "\"lobes\"",
               R"("exemplar_rms": 0.1, "color": {"axis": [1, 0, 0], "mean": [0.5, 0.25, 1]}, "lobes")"));
  const auto texture = [&](const std::string& name, std::vector<std::string> more) {
    const std::string file = (folder_ / name).string();
    std::vector<std::string> arguments{recipe, "--texture", "96x64", "-o", file};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const testing::Outcome outcome = run_program(kSynth, arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return text_of(file);
  };
  const auto bits_and_type = [](const std::string& png) { return png.substr(24, 2); };
  EXPECT_EQ(bits_and_type(texture("c16.png", {})), "\x10\x02");
  EXPECT_EQ(bits_and_type(texture("c8.png", {"--bits", "8", "--tileable"})), "\x08\x02");
  EXPECT_EQ(bits_and_type(texture("h.png", {"--texture-of", "height"})), std::string("\x10\x00", 2));
  EXPECT_GT(texture("c.tif", {}).size(), 3u * 96u * 64u * 4u);
  const std::string grey = folder_.write("g.json", kTexture), output = (folder_ / "x.png").string();
  expect_refusal(folder_, kSynth, {grey, "--texture", "96x64", "-o", output, "--texture-of", "color"},
                 "g.json");
  expect_refusal(folder_, kSynth, {folder_.write("r.json", kTwoSpheres), "--tileable", "-o", output},
                 "--tileable");
}

TEST_F(Synth, TextureIsDeterministicAndRefusesNonsense) {
  const std::string recipe = folder_.write("t.json", kTexture);
  const auto texture = [&](const std::string& name, const std::string& threads) {
    const std::string file = (folder_ / name).string();
    const testing::Outcome outcome =
        run_program(kSynth, {recipe, "--texture", "96x64", "-o", file, "--threads", threads});
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return text_of(file);
  };
  const std::string one = texture("one.png", "1");
  EXPECT_GT(one.size(), 1000u);
  EXPECT_TRUE(one == texture("two.png", "2"));
  EXPECT_GT(texture("height.tif", "1").size(), 96u * 64u * 4u);
  const std::string output = (folder_ / "x.png").string();
  for (const char* size : {"96", "0x64", "96x-1", "ax64", "1000000x1000000"}) {
    expect_refusal(folder_, kSynth, {recipe, "--texture", size, "-o", output}, "texture");
  }
  expect_refusal(folder_, kSynth, {folder_.write("r.json", kTwoSpheres), "--texture", "8x8", "-o", output},
                 "r.json");
}

}  // namespace
}  // namespace astrolith
