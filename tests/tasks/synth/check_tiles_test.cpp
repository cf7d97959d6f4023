// check_tiles, on tiles that synth makes.
#include "tasks/synth/check_tiles.h"

#include <cmath>
#include <cstring>
#include <random>

#include "geometry/io/mesh_io.h"
#include "geometry/mesh_measure.h"
#include "numerics/files/sha256.h"
#include "tests/support/meshes.h"
#include "tests/tasks/synth/synth_runner.h"

namespace astrolith {
namespace {

using nlohmann::ordered_json;
using testing::has;
using testing::Outcome;

constexpr int kTiles = 8;

class CheckTiles : public SynthTest {
 protected:
  static std::string mesh_name(int number) { return "tile_" + std::to_string(number) + ".ply"; }
  static std::string summary(int number) { return "tile_" + std::to_string(number) + ".json"; }
  static std::string summaries() {
    std::string names;
    for (int i = 1; i <= kTiles; ++i) names += summary(i) + " ";
    return names;
  }

  void make_tile(int number, const std::string& more = "--resolution 96") {
    succeed("r.json -o " + mesh_name(number) + " --device cpu --tile " + std::to_string(number) + "/" +
            std::to_string(kTiles) + " --summary " + summary(number) + " " + more);
  }
  void make_tiles() {
    for (int i = 1; i <= kTiles; ++i) make_tile(i);
  }

  Outcome check(const std::string& line) const {
    return testing::run_job("check_tiles", declare_check_tiles, testing::split_words(line), folder_.path());
  }
  Outcome check_with_meshes() const { return check(summaries() + "--meshes ."); }
  void refuse_tiles(const std::string& line, const std::string& culprit) const {
    testing::expect_refusal(folder_, "check_tiles", culprit, [&] { return check(line); });
  }
  static void expect_failure(const Outcome& outcome, const std::string& words) {
    EXPECT_EQ(outcome.status, 1) << outcome.errors;
    EXPECT_TRUE(has(outcome.errors, words));
    EXPECT_FALSE(has(outcome.errors, "closed, manifold"));
  }

  ordered_json certificate(int number) const { return ordered_json::parse(text(summary(number))); }
  // Changes a certificate as a forger would, checksum and all.
  void forge(int number, const std::function<void(ordered_json&)>& change) const {
    ordered_json document = certificate(number);
    ordered_json& tile = document["tile"];
    tile.erase("checksum");
    change(tile);
    tile["checksum"] = sha256(tile.dump());
    write(summary(number), document.dump());
  }
};

// The corners of all triangles, each triangle from its least corner on, sorted.
std::vector<std::array<std::array<double, 3>, 3>> triangle_corners(const TriangleMesh& mesh) {
  std::vector<std::array<std::array<double, 3>, 3>> all;
  for (const Triangle& t : mesh.triangles) {
    auto& c = all.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d& p = mesh.vertices[t[k]];
      c[k] = {p.x, p.y, p.z};
    }
    std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
  }
  std::sort(all.begin(), all.end());
  return all;
}

TEST_F(CheckTiles, TilesThatJoinAreTheWholeMesh) {
  make_tiles();
  const auto made = figures("r.json -o whole.ply --resolution 96 --device cpu");
  TriangleMesh all;
  for (int i = 1; i <= kTiles; ++i) all = testing::joined(all, read_mesh(folder_ / mesh_name(i)));
  const TriangleMesh mesh = read_mesh(folder_ / "whole.ply");
  EXPECT_TRUE(triangle_corners(all) == triangle_corners(mesh));

  std::vector<std::string> names = testing::split_words(summaries());
  std::shuffle(names.begin(), names.end(), std::mt19937(7));
  std::string shuffled;
  for (const std::string& name : names) shuffled += name + " ";
  for (const bool meshes : {false, true}) {
    const Outcome outcome = check(shuffled + "--summary report.json" + (meshes ? " --meshes ." : ""));
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    EXPECT_TRUE(has(outcome.errors, "complete, closed, manifold; 7 of 7 seams"));
    const auto found = json("report.json");
    EXPECT_TRUE(found["closed_manifold"]);
    EXPECT_EQ(found["meshes_read"], meshes);
    EXPECT_EQ(found["triangles"], made["triangles"]);
    EXPECT_EQ(found["vertices"], made["vertices"]);
    EXPECT_EQ(found["euler_characteristic"], 2 * (made["components"].get<int>() - made["genus"].get<int>()));
    EXPECT_NEAR(found["volume"], volume(mesh), 1e-12 * volume(mesh));
  }
}

TEST_F(CheckTiles, TilesWithoutSurfaceCount) {
  write("r.json", replaced(ball_recipe("km", 1), "]]", "], [0, 0, 8, 0.75]]"));
  make_tiles();
  EXPECT_TRUE(exists(mesh_name(4)));
  const Outcome outcome = check_with_meshes();
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_TRUE(has(outcome.errors, "Euler characteristic 4,"));
}

// Points hold no faces, which could join.
TEST_F(CheckTiles, PointsAreNotCertified) {
  make_tile(2, "--resolution 96 --points");
  EXPECT_FALSE(certificate(2).contains("tile"));
}

TEST_F(CheckTiles, MissingTilesAreNamedAndSeamsBetweenTheOthersCertified) {
  make_tiles();
  const Outcome outcome = check("tile_1.json tile_2.json tile_3.json tile_5.json --summary report.json");
  expect_failure(outcome, "4 tiles of 8: 2 of 7 seams certified");
  expect_failure(outcome, "make the missing ones: 4, 6-8");
  const auto found = json("report.json");
  EXPECT_FALSE(found["complete"]);
  EXPECT_FALSE(found["closed_manifold"]);
  EXPECT_EQ(found["seams_certified"], 2);
}

TEST_F(CheckTiles, TilesOfOtherSetsAreRefused) {
  make_tiles();
  refuse_tiles("tile_1.json tile_2.json tile_1.json", "is tile 1, as");
  make_tile(3, "--resolution 96 --seed 9");
  refuse_tiles(summaries(), "tile_3.json: is of another recipe or seed than");
  make_tile(3, "--resolution 100");
  refuse_tiles(summaries(), "tile_3.json: is of resolution 100, not 96");
}

TEST_F(CheckTiles, SidesThatDifferDoNotFit) {
  make_tiles();
  const std::string good = text(summary(3));
  forge(3, [](ordered_json& tile) { tile["upper"]["sha256"] = tile["lower"]["sha256"]; });
  expect_failure(check(summaries()), "tile_4.json: do not fit: their vertices lie at other places");
  expect_failure(check_with_meshes(), "tile_3.json certifies: its upper side has other edges");
  write("tile_3.json", good);
  forge(3, [](ordered_json& tile) {
    tile["lower"]["vertices"] = tile["lower"]["vertices"].get<int>() + 2;
    tile["euler_characteristic"] = tile["euler_characteristic"].get<int>() - 1;
  });
  expect_failure(check(summaries()), "vertices on 1 loop meet");
  write("tile_3.json", good);
  forge(3, [](ordered_json& tile) { tile["lower"]["z"] = tile["lower"]["z"].get<double>() - 0.125; });
  expect_failure(check(summaries()), "do not fit: they are cut at");
  // A tile of another seed whose certificate names this recipe.
  write("tile_3.json", good);
  const ordered_json honest = ordered_json::parse(good);
  make_tile(3, "--resolution 96 --seed 9");
  forge(3, [&](ordered_json& tile) { tile["recipe_sha256"] = honest["tile"]["recipe_sha256"]; });
  expect_failure(check_with_meshes(), "do not fit");
}

// Moves a coordinate of one vertex in the plane z by one step of a float.
void move_a_vertex(const std::filesystem::path& mesh, float z, std::size_t axis) {
  constexpr std::size_t kVertexBytes = 24;
  std::string bytes = testing::read_text(mesh);
  std::size_t at = bytes.find("end_header\n") + 11;
  std::array<float, 3> p{};
  for (;; at += kVertexBytes) {
    ASSERT_LE(at + kVertexBytes, bytes.size());
    std::memcpy(p.data(), bytes.data() + at, sizeof p);
    if (p[2] == z) break;
  }
  p[axis] = std::nextafter(p[axis], p[axis] < 0.0f ? -10.0f : 10.0f);
  std::memcpy(bytes.data() + at, p.data(), sizeof p);
  std::ofstream(mesh, std::ios::binary) << bytes;
}

TEST_F(CheckTiles, AVertexOfABorderThatMovedByOneStepIsSeen) {
  make_tiles();
  const std::string summary_3 = text(summary(3)), mesh_3 = text(mesh_name(3));
  const float z = certificate(3)["tile"]["upper"]["z"];
  const char* words[] = {"its upper side has other edges", "its upper side has other edges",
                         "it is open elsewhere than at its sides"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    write("tile_3.json", summary_3);
    write(mesh_name(3), mesh_3);
    move_a_vertex(folder_ / mesh_name(3), z, axis);
    expect_failure(check_with_meshes(), "its bytes have another SHA-256");
    EXPECT_EQ(check(summaries()).status, 0) << "certificates alone cannot know";
    forge(3, [&](ordered_json& tile) { tile["file_sha256"] = file_sha256(folder_ / mesh_name(3)); });
    expect_failure(check_with_meshes(), words[axis]);
  }
}

TEST_F(CheckTiles, DamagedMeshesAreNamed) {
  make_tiles();
  const auto expect = [&](const std::string& words) {
    forge(2, [&](ordered_json& tile) { tile["file_sha256"] = file_sha256(folder_ / mesh_name(2)); });
    const Outcome outcome = check_with_meshes();
    EXPECT_NE(outcome.status, 0);
    EXPECT_TRUE(has(outcome.errors, words));
  };
  const std::string good = text(mesh_name(2));
  write(mesh_name(2), good.substr(0, good.size() - 1));
  expect("its size does not agree with the counts in its header");
  std::string bad = good;
  std::fill(bad.end() - 12, bad.end(), '\xff');
  write(mesh_name(2), bad);
  expect("is no triangle of the file's vertices");
  bad = good;
  std::copy_n(good.end() - 26, 13, bad.end() - 13);  // the last triangle is the one before
  write(mesh_name(2), bad);
  expect("it is not manifold");
  write(mesh_name(2), text(mesh_name(3)));
  expect("tile_2.json certifies: it");
  std::filesystem::remove(folder_ / mesh_name(2));
  EXPECT_EQ(check_with_meshes().status, 2);
}

TEST_F(CheckTiles, BadCertificatesAreRefused) {
  make_tile(2);
  const std::string good = text(summary(2));
  const auto refuse = [&](const std::string& content, const std::string& culprit) {
    refuse_tiles(write("tile_2.json", content), culprit);
  };
  refuse(good.substr(0, good.size() / 2), "is no whole JSON object");
  refuse(std::string(60000, '['), "is nested too deeply");
  refuse(std::string((1 << 16) + 1, ' '), "is larger than 64 kB");
  refuse("{}", "tile: is missing");
  refuse(R"({"tile": 3})", "tile: is no object");
  refuse(R"({"tile": {}})", "is missing");
  const auto refuse_field = [&](const char* name, const ordered_json& value, const std::string& culprit) {
    ordered_json changed = ordered_json::parse(good);
    changed["tile"][name] = value;
    refuse(changed.dump(), culprit);
  };
  refuse_field("length_unit", "mm", "tile: was changed since synth wrote it");
  refuse_field("euler_characteristic", 7, "tile: was changed");
  refuse_field("euler_characteristic", {}, "tile: was changed");
  ordered_json without = ordered_json::parse(good);
  without["tile"].erase("euler_characteristic");
  refuse(without.dump(), "tile: was changed");
  refuse_field("checksum", std::string(64, '0'), "tile: was changed");
  refuse_field("triangles", ordered_json::parse(good)["tile"]["triangles"].get<int>() + 2,
               "tile: was changed");
  refuse_field("count", 1e300, "tile.count: is no whole number");
  refuse_field("count", std::uint64_t{1} << 63, "tile.count: is no whole number");
  refuse_field("count", 2000000000, "tile.count: is out of range");
  refuse_field("number", 9, "tile.number: is out of range");
  refuse_field("number", 8, "tile: has other sides than tile 8 of 8");
  refuse_field("vertices", -1, "tile.vertices: is out of range");
  refuse_field("volume", "1", "tile.volume: is no number");
  refuse_field("file", 7, "tile.file: is no text");
  refuse_field("file_sha256", "abc", "tile.file_sha256: is no SHA-256");
  refuse_field("lower", ordered_json::array(), "tile.lower: is no object");
  refuse_field("lower", {{"z", 1e300}, {"vertices", 0}, {"loops", 0}, {"sha256", ""}}, "tile_2.json: ");
  refuse_tiles("", "summaries");
  refuse_tiles(summary(7), "tile_7.json: ");
}

TEST_F(CheckTiles, EvenTilesJoinPlainOnes) {
  for (int i = 1; i <= kTiles; ++i) make_tile(i, i % 2 == 0 ? "--resolution 96 --even" : "--resolution 96");
  EXPECT_EQ(check(summaries()).status, 0);
}

}  // namespace
}  // namespace astrolith
