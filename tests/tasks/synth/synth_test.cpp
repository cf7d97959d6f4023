// synth: the whole mesh.
#include <algorithm>

#include "geometry/io/mesh_io.h"
#include "geometry/mesh_topology.h"
#include "numerics/files/sha256.h"
#include "numerics/files/zstd_stream.h"
#include "tests/tasks/synth/synth_runner.h"

namespace astrolith {
namespace {

using testing::has;

using Synth = SynthTest;

// The recipe's Gabor or fractal layers, by a GPU or without one.
TEST_F(Synth, TheDeviceChangesNothing) {
  const std::string by_cpu = synthesise("cpu.ply", "--device cpu");
  EXPECT_EQ(synthesise("auto.ply", "--device auto"), by_cpu);
  EXPECT_TRUE(has(succeed("r.json -o auto.ply --resolution 16 --device auto"), "; computed on "));
  const testing::Outcome outcome = run("r.json -o cuda.ply --resolution 32 --device cuda");
  if (outcome.status == 0) {
    EXPECT_EQ(text("cuda.ply"), by_cpu);
  } else {
    EXPECT_EQ(outcome.status, 2);
    EXPECT_TRUE(has(outcome.errors, "--device cuda: "));
  }
}

TEST_F(Synth, FeaturesAreListedAsDrawn) {
  const std::string craters = replaced(kTwoSpheres, "\"layers\": [", R"("layers": [{"type": "craters",
    "craters": [{"direction": [0, 0, 1], "diameter": 0.5, "age": 9}], "complex_from": 0.4,
    "population": {"count": 20, "least_diameter": 0.05, "greatest_diameter": 0.3}},
    {"type": "boulders", "boulders": [{"direction": [0, 1, 0], "axes": [0.3, 0.2, 0.1]}]}, )");
  write("c.json", craters);
  for (const std::string list : {"f.csv", "f.json"}) {
    succeed("c.json -o c.ply --resolution 24 --feature-list " + list);
  }
  const auto document = json("f.json");
  EXPECT_EQ(document["length_unit"], "km");
  ASSERT_EQ(document["features"].size(), 22u);
  EXPECT_EQ(document["features"][21]["kind"], "boulder");
  EXPECT_EQ(document["features"][21]["axis_b"], 0.2);
  EXPECT_FALSE(document["features"][21].contains("depth"));
  EXPECT_EQ(document["features"][0]["kind"], "complex crater");  // the oldest
  EXPECT_EQ(document["features"][0]["depth"], 0.03);
  const std::string csv = text("f.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 23);
  EXPECT_EQ(csv.rfind("layer,kind,x,y,z,mesh_x,mesh_y,mesh_z,center_x,", 0), 0u) << csv;
  expect_recipe_refused(replaced(craters, "\"diameter\": 0.5", "\"diameter\": 50"),
                        "layers[0].craters[0].diameter: is 50");
}

TEST_F(Synth, GravityComesWithTheMesh) {
  synthesise("plain.ply");
  const std::string bytes = synthesise("g.ply", "--gravity 2000 6 --summary s.json");
  for (const std::string name : {"potential_J_kg", "geopotential_J_kg", "slope_deg", "elevation_m"}) {
    EXPECT_NE(bytes.find("property float " + name + "\n"), std::string::npos) << name;
  }
  const TriangleMesh mesh = read_mesh(folder_ / "g.ply"), same = read_mesh(folder_ / "plain.ply");
  EXPECT_TRUE(mesh.vertices == same.vertices);
  EXPECT_TRUE(mesh.triangles == same.triangles);
  const auto gravity = json("s.json")["gravity"];
  // Two balls of 1 and 0.75 km: U at the surface is about G M / r.
  EXPECT_NEAR(gravity["potential_J_kg"]["mean"], -0.65, 0.15);
  EXPECT_GT(gravity["slope_deg"]["max"], 10.0);
  EXPECT_LE(gravity["achieved_error"]["largest"], 1e-6);
  EXPECT_EQ(synthesise("one.ply", "--gravity 2000 6 --threads 1"), bytes);
}

TEST_F(Synth, WritesIcqAndPlates) {
  synthesise("a.tab");
  EXPECT_TRUE(analyze_topology(read_mesh(folder_ / "a.tab")).closed);
  const auto made = figures(write("ball.json", ball_recipe("km", 1)) + " -o a.icq --resolution 32");
  const TriangleMesh icq = read_mesh(folder_ / "a.icq");
  EXPECT_TRUE(analyze_topology(icq).closed);
  EXPECT_EQ(made["triangles"], icq.triangles.size());
  EXPECT_EQ(made["vertices"], icq.vertices.size());
  for (const std::string extension : {".tab", ".icq", ".obj"}) {
    const std::string said =
        succeed(write("m.json", ball_recipe("m", 1)) + " --resolution 16 -o m" + extension);
    EXPECT_EQ(testing::has(said, "note: a " + extension + " states no unit; read it with --unit m\n"),
              extension != ".obj")
        << said;
  }
  write("apart.json", replaced(ball_recipe("km", 1), "]]", "], [9, 0, 0, 1]]"));
  refuse("apart.json -o b.icq --resolution 32", "b.icq");
}

TEST_F(Synth, EveryFormatHoldsTheSameMesh) {
  synthesise("out.ply");
  const TriangleMesh ply = read_mesh(folder_ / "out.ply");
  for (const char* name : {"out.obj", "out.stl"}) {
    synthesise(name);
    EXPECT_EQ(read_mesh(folder_ / name).triangles.size(), ply.triangles.size()) << name;
  }
  EXPECT_EQ(synthesise("out.glb").substr(0, 4), "glTF");
  EXPECT_NE(synthesise("uv.glb", "--uv").find("TEXCOORD_0"), std::string::npos);
  EXPECT_EQ(unpack_zstd(synthesise("body.ply.zst"), 100'000'000), synthesise("body.ply"));
}

TEST_F(Synth, BytesDependOnTheSeedAndNotOnThreads) {
  const std::string one = synthesise("one.ply", "--seed 5 --threads 1");
  EXPECT_GT(one.size(), 10000u);
  EXPECT_TRUE(one == synthesise("two.ply", "--seed 5 --threads 2"));
  EXPECT_TRUE(one == synthesise("eight.ply", "--seed 5 --threads 8"));
  EXPECT_FALSE(one == synthesise("other.ply", "--seed 6"));
}

TEST_F(Synth, SummaryHoldsTheFigures) {
  const auto summary = figures("r.json -o out.ply --resolution 32");
  for (const char* field : {"evaluations", "seconds", "peak_bytes"}) {
    EXPECT_TRUE(summary.contains(field)) << field;
  }
  const TriangleMesh mesh = read_mesh(folder_ / "out.ply");
  const MeshTopology topology = analyze_topology(mesh);
  EXPECT_TRUE(topology.closed && topology.manifold && topology.components == 1);
  EXPECT_EQ(summary["vertices"], mesh.vertices.size());
  EXPECT_EQ(summary["triangles"], mesh.triangles.size());
  EXPECT_EQ(summary["closed"], true);
  EXPECT_EQ(summary["manifold"], true);
  EXPECT_EQ(summary["genus"], topology.genus);
  EXPECT_EQ(summary["sha256"], file_sha256(folder_ / "out.ply"));
}

// The whole mesh's file without its faces, but for the header.
TEST_F(Synth, PointsAreTheVerticesAlone) {
  const std::string mesh = synthesise("mesh.ply"), points = synthesise("points.ply", "--points");
  const auto body = [](const std::string& file) { return file.substr(file.find("end_header\n")); };
  EXPECT_NE(points.find("element face 0\n"), std::string::npos);
  EXPECT_GT(body(points).size(), 10000u);
  EXPECT_EQ(body(points), body(mesh).substr(0, body(points).size()));
}

TEST_F(Synth, LabelsStandBesideTheNormals) {
  const std::string bytes = synthesise("labels.ply", "--labels");
  EXPECT_NE(bytes.find("comment label 0: the bare body\ncomment label 1: simplex\n"), std::string::npos);
  EXPECT_NE(bytes.find("property float nz\nproperty int label\nproperty float elevation\n"),
            std::string::npos);
  synthesise("plain.ply");
  const TriangleMesh labelled = read_mesh(folder_ / "labels.ply"), plain = read_mesh(folder_ / "plain.ply");
  EXPECT_TRUE(labelled.vertices == plain.vertices && labelled.triangles == plain.triangles);
  EXPECT_NE(synthesise("points.ply", "--labels --points").find("element face 0\n"), std::string::npos);
}

TEST_F(Synth, SmallPiecesAreLeftOut) {
  write("r.json", replaced(kTwoSpheres, "[1, 0, 0, 0.75]", "[1, 0, 0, 0.75], [2.6, 0, 0, 0.15]"));
  const std::string line = "r.json -o x.ply --resolution 64";
  EXPECT_EQ(figures(line).at("components"), 2);
  EXPECT_EQ(figures(line + " --min-component 0.01").at("components"), 1);
  EXPECT_EQ(analyze_topology(read_mesh(folder_ / "x.ply")).components, 1);
}

TEST_F(Synth, ErosionSettlesAndIsOfTheWhole) {
  write("r.json", replaced(kTwoSpheres, "\"layers\"", "\"erosion\": {\"talus_angle\": 30}, \"layers\""));
  const std::string line = "r.json -o x.ply --resolution 40";
  const auto bytes = [&](const std::string& threads) {
    succeed(line + " --summary s.json --threads " + threads);
    return text("x.ply");
  };
  EXPECT_TRUE(bytes("1") == bytes("4"));
  const auto summary = json("s.json");
  EXPECT_TRUE(summary.at("closed"));
  EXPECT_TRUE(summary.at("erosion").at("settled"));
  EXPECT_LE(summary.at("erosion").at("steepest_after"), 30.0);
  EXPECT_GT(summary.at("erosion").at("steepest_before"), 31.0);
  refuse(line + " --tile 1/2", "--tile");
}

TEST_F(Synth, TrianglesChooseTheResolution) {
  const auto made = figures("r.json -o out.obj --triangles 30000");
  EXPECT_NEAR(made["triangles"], 30e3, 3e3);
  EXPECT_NEAR(made["predicted"]["triangles"], 30e3, 2e3);
}

TEST_F(Synth, PredictionWritesNothing) {
  const testing::Outcome said = run("r.json -o x.ply --resolution 64 --predict --summary s.json");
  EXPECT_TRUE(has(said.output, "triangles"));
  EXPECT_EQ(said.errors, "");
  EXPECT_EQ(folder_.files(), (std::set<std::string>{"r.json", "s.json"}));
  for (const char* figure : {"triangles", "file_bytes", "peak_bytes", "seconds", "processor_seconds"}) {
    EXPECT_GT(json("s.json").at("predicted").at(figure), 0.0) << figure;
  }
}

TEST_F(Synth, EveningIsMeasured) {
  const std::string said = succeed("r.json -o even.ply --resolution 64 --even --summary s.json");
  const auto summary = json("s.json"), even = summary["even"];
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

TEST_F(Synth, EveningHasTheSameBytesForAnyThreadsAndTheTrianglesAsWithout) {
  const std::string one = synthesise("a.ply", "--even --threads 1");
  EXPECT_EQ(synthesise("b.ply", "--even --threads 3"), one);
  EXPECT_NE(synthesise("plain.ply"), one);
  EXPECT_EQ(read_mesh(folder_ / "a.ply").triangles, read_mesh(folder_ / "plain.ply").triangles);
}

TEST_F(Synth, EveningTakesMemoryThatIsPredicted) {
  const auto bytes = [&](const std::string& more) {
    return figures("r.json --predict --resolution 1024" + more)["predicted"]["peak_bytes"].get<double>();
  };
  EXPECT_GT(bytes(" --even"), bytes(""));
}

TEST_F(Synth, EveningGoesWithOtherOptions) {
  for (const std::string options : {"even.obj", "even.glb", "even.ply.zst --min-component 0.001",
                                    "even.ply --labels", "even.ply --patch -1 0 0 0.5"}) {
    const auto even = figures("r.json --resolution 32 --even -o " + options).at("even");
    EXPECT_GT(even["moved_vertices"], 100) << options;
    EXPECT_GT(even["quality_after"]["mean"], even["quality_before"]["mean"]) << options;
  }
}

}  // namespace
}  // namespace astrolith
