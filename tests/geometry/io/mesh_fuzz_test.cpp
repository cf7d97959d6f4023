// A damaged file of any format gives a valid mesh or an InputError, and nothing else.

#include "geometry/io/mesh_io.h"
#include "geometry/mesh_measure.h"
#include "geometry/mesh_topology.h"
#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "tests/support/scratch_folder.h"

namespace astrolith {
namespace {

using namespace testing;

class MeshFuzz : public ::testing::TestWithParam<const char*> {
 protected:
  // A valid file, with which the fuzzer of the format begins too.
  std::string valid_file() { return read_text(std::filesystem::path(ASTROLITH_FUZZ_SEEDS) / GetParam()); }
  // True when the file was read.
  bool survives(const std::string& content) {
    const std::filesystem::path file = folder.write(std::filesystem::path(GetParam()).filename(), content);
    try {
      check(read_mesh(file));
      return true;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      return false;
    }
  }
  static void check(const TriangleMesh& mesh) {
    EXPECT_FALSE(mesh.triangles.empty());
    EXPECT_TRUE(mesh.normals.empty() || mesh.normals.size() == mesh.vertices.size());
    for (const Triangle& t : mesh.triangles) {
      for (const std::uint32_t index : t) ASSERT_LT(index, mesh.vertices.size());
    }
    for (const Vec3d& p : mesh.vertices) ASSERT_TRUE(std::isfinite(squared_norm(p)));
  }
  ScratchFolder folder;
};

TEST_P(MeshFuzz, TheValidFileReads) { EXPECT_TRUE(survives(valid_file())); }

TEST_P(MeshFuzz, TruncatedAnywhere) {
  const std::string valid = valid_file();
  for (std::size_t length = 0; length < valid.size(); ++length) survives(valid.substr(0, length));
}

TEST_P(MeshFuzz, BytesReplaced) {
  const std::string valid = valid_file();
  CounterRandom random(11);
  for (int round = 0; round < 1500; ++round) {
    std::string damaged = valid;
    for (std::uint64_t n = 1 + random.below(4); n > 0; --n) {
      char& byte = damaged[random.below(damaged.size())];
      // Digits and signs reach deeper into text readers than random bytes do.
      byte = random.uniform() < 0.5 ? static_cast<char>(random.below(256))
                                    : "0123456789-+.eEn/ \n#"[random.below(20)];
    }
    survives(damaged);
  }
}

TEST_P(MeshFuzz, PiecesRepeatedAndRemoved) {
  const std::string valid = valid_file();
  CounterRandom random(12);
  for (int round = 0; round < 500; ++round) {
    std::string damaged = valid;
    const std::size_t from = random.below(damaged.size()), length = 1 + random.below(40);
    if (random.uniform() < 0.5) {
      damaged.erase(from, length);
    } else {
      damaged.insert(random.below(damaged.size()), damaged.substr(from, length));
    }
    if (!damaged.empty()) survives(damaged);
  }
}

// What the valid files hold.
// A node around others scales, one inside turns +z up into +y up and shifts; what only collides is no
// surface.
TEST(MeshSeeds, GlbIsTheSceneInMetresWithZUp) {
  const std::filesystem::path file = std::filesystem::path(ASTROLITH_FUZZ_SEEDS) / "glb/tetrahedron.glb";
  const TriangleMesh mesh = read_mesh(file);
  EXPECT_EQ(stated_length_unit(file), "m");
  EXPECT_NEAR(volume(mesh), 8.0 / 6.0, 1e-12);
  ASSERT_EQ(mesh.vertices.size(), 4u);
  EXPECT_TRUE(analyze_topology(mesh).closed);
  const Box box = mesh.bounds();
  EXPECT_TRUE(box.min == (Vec3d{0, -10, 0}));  // z of the file is -y here: 2 * 5
  EXPECT_TRUE(box.max == (Vec3d{2, -8, 2}));
}

TEST(MeshSeeds, DskHasThePlatesOfItsSegments) {
  const std::filesystem::path file = std::filesystem::path(ASTROLITH_FUZZ_SEEDS) / "dsk/tetrahedron.bds";
  const TriangleMesh mesh = read_mesh(file);
  EXPECT_TRUE((mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}));
  EXPECT_TRUE(mesh.vertices[1] == (Vec3d{0, 1, 0}));
  EXPECT_EQ(stated_length_unit(file), "km");
}

INSTANTIATE_TEST_SUITE_P(EveryFormat, MeshFuzz,
                         ::testing::Values("obj/tetrahedron.obj", "obj/polygons.obj", "ply/ascii.ply",
                                           "ply/little.ply", "ply/big.ply", "stl_binary/binary.stl",
                                           "stl_ascii/ascii.stl", "off/plain.off", "plate/one_count.tab",
                                           "icq/cube_1.icq", "bmf/tetrahedron.bmf", "glb/tetrahedron.glb",
                                           "dsk/tetrahedron.bds", "plate/type_4.ver", "grid_table/plain.tab",
                                           "grid_table/named.csv", "grid_table/labelled.tab"));

}  // namespace
}  // namespace astrolith
