// check_tiles, run as a user runs it, on tiles that synth makes; and the borders that it compares.
#include <cmath>
#include <cstring>
#include <random>

#include "geometry/io/mesh_io.h"
#include "geometry/mesh_measure.h"
#include "numerics/files/sha256.h"
#include "synthesis/mesh/tile_border.h"
#include "tests/apps/synth_runner.h"
#include "tests/support/meshes.h"

namespace astrolith {
namespace {

const std::string kCheckTiles = ASTROLITH_CHECK_TILES;

using testing::has;
using testing::Outcome;
using Json = nlohmann::ordered_json;

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
    return testing::run_program(kCheckTiles, testing::words_of(line), folder_.path());
  }
  Outcome check_with_meshes() const { return check(summaries() + "--meshes ."); }
  void refuse_tiles(const std::string& line, const std::string& culprit) const {
    testing::expect_refusal(folder_, kCheckTiles, testing::words_of(line), culprit);
  }
  static void expect_failure(const Outcome& outcome, const std::string& words) {
    EXPECT_EQ(outcome.status, 1) << outcome.errors;
    EXPECT_TRUE(has(outcome.errors, words));
    EXPECT_FALSE(has(outcome.errors, "closed, manifold"));
  }

  Json certificate(int number) const { return Json::parse(text(summary(number))); }
  // Changes a certificate as a forger would, checksum and all.
  void forge(int number, const std::function<void(Json&)>& change) const {
    Json document = certificate(number);
    Json& tile = document["tile"];
    tile.erase("checksum");
    change(tile);
    Sha256 hash;
    const std::string bytes = tile.dump();
    hash.update(bytes.data(), bytes.size());
    tile["checksum"] = hash.hex();
    write(summary(number), document.dump());
  }
};

// The corners of all triangles, each triangle from its least corner on, sorted.
std::vector<std::array<Vec3d, 3>> corners_of(const TriangleMesh& mesh) {
  const auto less = [](const Vec3d& a, const Vec3d& b) {
    return std::array{a.x, a.y, a.z} < std::array{b.x, b.y, b.z};
  };
  std::vector<std::array<Vec3d, 3>> all;
  for (const Triangle& t : mesh.triangles) {
    std::array<Vec3d, 3> c{mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
    std::rotate(c.begin(), std::min_element(c.begin(), c.end(), less), c.end());
    all.push_back(c);
  }
  std::sort(all.begin(), all.end(), [&](const auto& a, const auto& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), less);
  });
  return all;
}

bool same_places(const std::vector<std::array<Vec3d, 3>>& a, const std::vector<std::array<Vec3d, 3>>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0;
}

TEST_F(CheckTiles, TilesThatJoinAreTheWholeMesh) {
  make_tiles();
  const auto made = figures("r.json -o whole.ply --resolution 96 --device cpu");
  TriangleMesh all;
  for (int i = 1; i <= kTiles; ++i) all = testing::joined(all, read_mesh(folder_ / mesh_name(i)));
  const TriangleMesh mesh = read_mesh(folder_ / "whole.ply");
  EXPECT_TRUE(same_places(corners_of(all), corners_of(mesh)));

  std::vector<std::string> names = testing::words_of(summaries());
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
  forge(3, [](Json& tile) { tile["upper"]["sha256"] = tile["lower"]["sha256"]; });
  expect_failure(check(summaries()), "tile_4.json: do not fit: their vertices lie at other places");
  expect_failure(check_with_meshes(), "tile_3.json certifies: its upper side has other edges");
  write("tile_3.json", good);
  forge(3, [](Json& tile) {
    tile["lower"]["vertices"] = tile["lower"]["vertices"].get<int>() + 2;
    tile["euler_characteristic"] = tile["euler_characteristic"].get<int>() - 1;
  });
  expect_failure(check(summaries()), "vertices on 1 loop meet");
  write("tile_3.json", good);
  forge(3, [](Json& tile) { tile["lower"]["z"] = tile["lower"]["z"].get<double>() - 0.125; });
  expect_failure(check(summaries()), "do not fit: they are cut at");
  // A tile of another seed whose certificate names this recipe.
  write("tile_3.json", good);
  const Json honest = Json::parse(good);
  make_tile(3, "--resolution 96 --seed 9");
  forge(3, [&](Json& tile) { tile["recipe_sha256"] = honest["tile"]["recipe_sha256"]; });
  expect_failure(check_with_meshes(), "do not fit");
}

// The float behind `value`, away from 0.
float next_float(float value) { return std::nextafter(value, value < 0.0f ? -10.0f : 10.0f); }

// Moves a coordinate of one vertex in the plane z by one step of a float.
void move_a_vertex(const std::filesystem::path& mesh, float z, std::size_t axis) {
  constexpr std::size_t kVertexBytes = 24;
  std::string bytes = testing::text_of(mesh);
  std::size_t at = bytes.find("end_header\n") + 11;
  std::array<float, 3> p{};
  for (;; at += kVertexBytes) {
    ASSERT_LE(at + kVertexBytes, bytes.size());
    std::memcpy(p.data(), bytes.data() + at, sizeof p);
    if (p[2] == z) break;
  }
  p[axis] = next_float(p[axis]);
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
    forge(3, [&](Json& tile) { tile["file_sha256"] = sha256_of_file(folder_ / mesh_name(3)); });
    expect_failure(check_with_meshes(), words[axis]);
  }
}

TEST_F(CheckTiles, DamagedMeshesAreNamed) {
  make_tiles();
  const auto expect = [&](const std::string& words) {
    forge(2, [&](Json& tile) { tile["file_sha256"] = sha256_of_file(folder_ / mesh_name(2)); });
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
  const auto refuse_field = [&](const char* name, const Json& value, const std::string& culprit) {
    Json changed = Json::parse(good);
    changed["tile"][name] = value;
    refuse(changed.dump(), culprit);
  };
  refuse_field("length_unit", "mm", "tile: was changed since synth wrote it");
  refuse_field("euler_characteristic", 7, "tile: was changed");
  refuse_field("euler_characteristic", {}, "tile: was changed");
  Json without = Json::parse(good);
  without["tile"].erase("euler_characteristic");
  refuse(without.dump(), "tile: was changed");
  refuse_field("checksum", std::string(64, '0'), "tile: was changed");
  refuse_field("triangles", Json::parse(good)["tile"]["triangles"].get<int>() + 2, "tile: was changed");
  refuse_field("count", 1e300, "tile.count: is no whole number");
  refuse_field("count", std::uint64_t{1} << 63, "tile.count: is no whole number");
  refuse_field("count", 2000000000, "tile.count: is out of range");
  refuse_field("number", 9, "tile.number: is out of range");
  refuse_field("number", 8, "tile: has other sides than tile 8 of 8");
  refuse_field("vertices", -1, "tile.vertices: is out of range");
  refuse_field("volume", "1", "tile.volume: is no number");
  refuse_field("file", 7, "tile.file: is no text");
  refuse_field("file_sha256", "abc", "tile.file_sha256: is no SHA-256");
  refuse_field("lower", Json::array(), "tile.lower: is no object");
  refuse_field("lower", {{"z", 1e300}, {"vertices", 0}, {"loops", 0}, {"sha256", ""}}, "tile_2.json: ");
  refuse_tiles("", "summaries");
  refuse_tiles(summary(7), "tile_7.json: ");
}

// An open pyramid over the square around the origin; below the plane z = 0 or above it.
struct Pyramid {
  std::vector<MeshVertex> vertices;
  std::vector<Triangle> triangles;
};
Pyramid pyramid(float apex) {
  Pyramid p;
  for (const auto& [x, y] : {std::array{1.0f, 1.0f}, {-1.0f, 1.0f}, {-1.0f, -1.0f}, {1.0f, -1.0f}}) {
    p.vertices.push_back({{x, y, 0.0f}, {}});
  }
  p.vertices.push_back({{0.0f, 0.0f, apex}, {}});
  for (std::uint32_t k = 0; k < 4; ++k) {
    const std::uint32_t next = (k + 1) % 4;
    p.triangles.push_back(apex > 0.0f ? Triangle{k, next, 4} : Triangle{next, k, 4});
  }
  return p;
}

std::optional<TileFigures> border_of(const Pyramid& pyramid, bool above) {
  TileBorder border(above ? std::optional(0.0f) : std::nullopt, above ? std::nullopt : std::optional(0.0f));
  border.add_vertices(pyramid.vertices);
  border.add_triangles(pyramid.triangles);
  return border.figures();
}

TEST(TileBorder, TwoPyramidsFit) {
  const Pyramid above = pyramid(1.0f), below = pyramid(-2.0f);
  const TileFigures a = *border_of(above, true), b = *border_of(below, false);
  EXPECT_EQ(*a.lower, *b.upper);
  EXPECT_EQ(a.lower->vertices, 4);
  EXPECT_EQ(a.lower->loops, 1);
  EXPECT_EQ(a.euler_characteristic() + b.euler_characteristic(), 2);
  EXPECT_NEAR(a.volume + b.volume, 4.0, 1e-15);
  // The numbers of the vertices do not matter.
  Pyramid turned = below;
  std::rotate(turned.vertices.begin(), turned.vertices.begin() + 3, turned.vertices.begin() + 4);
  for (Triangle& t : turned.triangles) {
    for (std::uint32_t& v : t) v = v == 4 ? 4 : (v + 1) % 4;
  }
  EXPECT_EQ(*border_of(turned, false)->upper, *a.lower);
}

TEST(TileBorder, OtherPlacesOtherEdgesAndTheOtherOrientationDoNotFit) {
  const TileSide good = *border_of(pyramid(1.0f), true)->lower;
  Pyramid moved = pyramid(-1.0f);
  moved.vertices[2].position.y = next_float(moved.vertices[2].position.y);
  EXPECT_NE(*border_of(moved, false)->upper, good);
  Pyramid crossed = pyramid(-1.0f);
  std::swap(crossed.vertices[1], crossed.vertices[2]);
  EXPECT_NE(*border_of(crossed, false)->upper, good);
  Pyramid flipped = pyramid(-1.0f);
  for (Triangle& t : flipped.triangles) std::swap(t[0], t[1]);
  EXPECT_NE(*border_of(flipped, false)->upper, good);
}

TEST(TileBorder, BordersThatAreNoLoopsHaveNoFigures) {
  Pyramid cut = pyramid(1.0f);
  cut.triangles.pop_back();
  EXPECT_FALSE(border_of(cut, true));
  Pyramid twice = pyramid(1.0f);
  twice.triangles.push_back(twice.triangles[0]);
  EXPECT_FALSE(border_of(twice, true));
  Pyramid touching = pyramid(1.0f);  // a second pyramid that shares vertex 0 with the first
  for (int k = 1; k < 4; ++k) touching.vertices.push_back(touching.vertices[static_cast<std::size_t>(k)]);
  touching.vertices.push_back({{0.0f, 0.0f, 3.0f}, {}});
  const auto second = [](std::uint32_t v) { return v == 0 ? 0 : v == 4 ? 8 : v + 4; };
  for (std::size_t k = 0; k < 4; ++k) {
    const Triangle t = touching.triangles[k];
    touching.triangles.push_back({second(t[0]), second(t[1]), second(t[2])});
  }
  EXPECT_FALSE(border_of(touching, true));
}

// Vertices that rounding put at one place are still vertices of their own.
TEST(TileBorder, VerticesAtOnePlaceAreTold) {
  Pyramid above = pyramid(1.0f), below = pyramid(-1.0f);
  above.vertices[1] = above.vertices[0];
  below.vertices[1] = below.vertices[0];
  EXPECT_EQ(*border_of(above, true)->lower, *border_of(below, false)->upper);
  EXPECT_EQ(border_of(above, true)->lower->vertices, 4);
}

}  // namespace
}  // namespace astrolith
