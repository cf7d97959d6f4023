// A damaged file of any format gives a valid mesh or an InputError, and nothing else.

#include "geometry/io/mesh_io.h"
#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "tests/support/data.h"
#include "tests/support/meshes.h"
#include "tests/support/scratch_folder.h"

namespace astrolith {
namespace {

using namespace testing;

const char* const kPlyAscii =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement "
    "face 4\n"
    "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 "
    "3\n3 0 3 2\n";
const char* const kOff = "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
const char* const kPlate = "4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n4\n1 1 3 2\n2 1 2 4\n3 2 3 4\n4 1 4 3\n";
const char* const kStl =
    "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
    "0\nendloop\nendfacet\nendsolid a\n";
// A cube as an ICQ: Q = 1, faces in Gaskell's order.
const char* const kIcq =
    "1\n-1 -1 1\n-1 1 1\n1 -1 1\n1 1 1\n1 -1 1\n1 1 1\n1 -1 -1\n1 1 -1\n-1 -1 1\n1 -1 1\n-1 -1 -1\n1 -1 -1\n"
    "-1 1 1\n-1 -1 1\n-1 1 -1\n-1 -1 -1\n1 1 1\n-1 1 1\n1 1 -1\n-1 1 -1\n1 -1 -1\n1 1 -1\n-1 -1 -1\n-1 1 "
    "-1\n";

std::string tiny_bmf() {
  const auto u16 = [](int value) {
    return std::string{static_cast<char>(value), static_cast<char>(value >> 8)};
  };
  std::string bytes = u16(1) + u16(0) + u16(2) + std::string("T\0", 2) + std::string(48, '\0') + u16(4);
  for (int corner = 0; corner < 4; ++corner) {
    for (int number = 0; number < 8; ++number) {
      bytes += number == 4 + corner ? std::string("\0\0\x80\x3f", 4) : std::string(4, '\0');
    }
  }
  bytes += u16(4);
  for (const int index : {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2}) bytes += u16(index);
  return bytes;
}

class MeshFuzz : public ::testing::TestWithParam<const char*> {
 protected:
  std::string valid_file() {
    const std::string name = GetParam();
    if (name == "ascii.ply") return kPlyAscii;
    if (name == "a.off") return kOff;
    if (name == "a.tab") return kPlate;
    if (name == "ascii.stl") return kStl;
    if (name == "a.icq") return kIcq;
    if (name == "a.bmf") return tiny_bmf();
    TriangleMesh mesh = octahedron();
    if (name == "normals.ply") mesh.normals = mesh.vertices;
    write_mesh(mesh, folder / name, {"km", "body-fixed", ""});
    return text_of(folder / name);
  }
  // True when the file was read.
  bool survives(const std::string& content) {
    const std::filesystem::path file = folder.write(GetParam(), content);
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
                         ::testing::Values("a.obj", "a.ply", "normals.ply", "ascii.ply", "a.stl", "ascii.stl",
                                           "a.off", "a.tab", "a.icq", "a.bmf"));

}  // namespace
}  // namespace astrolith
