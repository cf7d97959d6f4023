// A damaged file of any format gives a valid mesh or an InputError, and nothing else.

#include "geometry/io/mesh_io.h"
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

INSTANTIATE_TEST_SUITE_P(EveryFormat, MeshFuzz,
                         ::testing::Values("obj/tetrahedron.obj", "obj/polygons.obj", "ply/ascii.ply",
                                           "ply/little.ply", "ply/big.ply", "stl_binary/binary.stl",
                                           "stl_ascii/ascii.stl", "off/plain.off", "plate/one_count.tab",
                                           "icq/cube_1.icq", "bmf/tetrahedron.bmf", "plate/type_4.ver",
                                           "grid_table/plain.tab", "grid_table/named.csv",
                                           "grid_table/labelled.tab"));

}  // namespace
}  // namespace astrolith
