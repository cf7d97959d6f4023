// synth, run as a user runs it: the whole mesh.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "geometry/io/mesh_io.h"
#include "geometry/mesh_topology.h"
#include "numerics/files/zstd_stream.h"
#include "recipe/sha256.h"
#include "tests/apps/synth_runner.h"

namespace astrolith {
namespace {

using testing::expect_refusal;
using testing::run_program;
using testing::text_of;

using Synth = SynthTest;

const std::string kDrawnCraters = R"({"format_version": 1, "length_unit": "m",
  "body": {"type": "metaballs", "spheres": [[0, 0, 0, 100]]},
  "layers": [{"type": "simplex", "amplitude": 3, "frequency": 0.02, "octaves": 3},
    {"type": "craters", "population": {"count": 2000, "exponent": 1.7, "least_diameter": 6, "greatest_diameter": 60}}]})";

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

TEST_F(Synth, EveryFormatHoldsTheSameMesh) {
  synthesise("out.ply", {});
  const TriangleMesh ply = read_mesh(folder_ / "out.ply");
  for (const char* name : {"out.obj", "out.stl"}) {
    synthesise(name, {});
    EXPECT_EQ(read_mesh(folder_ / name).triangles.size(), ply.triangles.size()) << name;
  }
  EXPECT_EQ(synthesise("out.glb", {}).substr(0, 4), "glTF");
  EXPECT_NE(synthesise("uv.glb", {"--uv"}).find("TEXCOORD_0"), std::string::npos);
  EXPECT_EQ(unpack_zstd(synthesise("body.ply.zst", {}), 100'000'000), synthesise("body.ply", {}));
}

TEST_F(Synth, SameBytesForAnyThreadCount) {
  const std::string one = synthesise("one.ply", {"--threads", "1"});
  EXPECT_GT(one.size(), 10000u);
  EXPECT_TRUE(one == synthesise("two.ply", {"--threads", "2"}));
  EXPECT_TRUE(one == synthesise("eight.ply", {"--threads", "8"}));
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

// The whole mesh's file without its faces, but for the header.
TEST_F(Synth, PointsAreTheVerticesAlone) {
  const std::string mesh = synthesise("mesh.ply", {}), points = synthesise("points.ply", {"--points"});
  const auto body = [](const std::string& file) { return file.substr(file.find("end_header\n")); };
  EXPECT_NE(points.find("element face 0\n"), std::string::npos);
  EXPECT_GT(body(points).size(), 10000u);
  EXPECT_EQ(body(points), body(mesh).substr(0, body(points).size()));
  const std::string recipe = folder_.write("r.json", kTwoSpheres);
  expect_refusal(folder_, kSynth, {recipe, "-o", (folder_ / "out.obj").string(), "--points"}, ".ply");
  expect_refusal(folder_, kSynth, {recipe, "-o", (folder_ / "out.obj").string(), "--uv"}, ".glb");
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

}  // namespace
}  // namespace astrolith
