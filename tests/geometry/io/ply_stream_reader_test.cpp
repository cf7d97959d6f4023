#include "geometry/io/ply_stream_reader.h"

#include <algorithm>
#include <random>

#include "geometry/io/ply_stream_writer.h"
#include "geometry/mesh_normals.h"
#include "numerics/errors.h"
#include "tests/support/meshes.h"
#include "tests/support/scratch_folder.h"

namespace astrolith {
namespace {

using namespace testing;

// Collects a mesh, and the number of vertices of the largest call.
class Collector : public MeshCollector {
 public:
  void add_vertices(std::span<const MeshVertex> vertices) override {
    EXPECT_FALSE(vertices.empty());
    before_ = last_;
    last_ = vertices.size();
    most = std::max(most, last_);
    MeshCollector::add_vertices(vertices);
  }
  void add_triangles(std::span<const Triangle> triangles) override {
    for (const Triangle& t : triangles) {
      for (const std::uint32_t v : t) {
        EXPECT_LT(v, mesh.vertices.size());
        EXPECT_GE(v + last_ + before_, mesh.vertices.size());
      }
    }
    MeshCollector::add_triangles(triangles);
  }
  std::size_t most = 0;

 private:
  std::size_t before_ = 0, last_ = 0;
};

// A strip of 200,000 triangles along x, in the order of the strip.
TriangleMesh strip() {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < 200002; ++i) mesh.vertices.push_back({0.5 * i, double(i % 2), 0.0});
  for (std::uint32_t i = 0; i < 200000; ++i) {
    mesh.triangles.push_back(i % 2 == 0 ? Triangle{i, i + 1, i + 2} : Triangle{i + 1, i, i + 2});
  }
  return mesh;
}

Collector read_back(const TriangleMesh& mesh, const std::filesystem::path& file) {
  write_mesh(mesh, file, {});
  PlyStreamReader reader(file);
  EXPECT_EQ(reader.num_vertices(), mesh.vertices.size());
  EXPECT_EQ(reader.num_triangles(), mesh.triangles.size());
  Collector collector;
  reader.read(collector);
  EXPECT_TRUE(collector.mesh.triangles == mesh.triangles);
  return collector;
}

TEST(PlyStreamReader, PassesOnWhatStandsInTheFile) {
  const ScratchFolder folder;
  TriangleMesh mesh = torus(2, 0.7);
  mesh.normals = vertex_normals(mesh);
  mesh.vertices.push_back({1.0, 2.0, 3.0});  // no triangle names it
  mesh.normals.push_back({0.0, 0.0, 1.0});
  const Collector collector = read_back(mesh, folder / "a.ply");
  ASSERT_EQ(collector.mesh.vertices.size(), mesh.vertices.size());
  EXPECT_EQ(collector.mesh.vertices.back().y, 2.0);
}

TEST(PlyStreamReader, CallsAreSmallWhereTheOrderAllowsIt) {
  const ScratchFolder folder;
  TriangleMesh mesh = strip();
  EXPECT_LT(read_back(mesh, folder / "a.ply").most, 60000u);
  std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), std::mt19937(3));
  read_back(mesh, folder / "b.ply");
}

TEST(PlyStreamReader, DamagedAndOtherFilesAreRefused) {
  const ScratchFolder folder;
  TriangleMesh mesh = torus(2, 0.7);
  write_mesh(mesh, folder / "a.ply", {});
  const std::string good = text_of(folder / "a.ply");
  const auto refuse = [&](const std::string& bytes) {
    const auto file = folder.write("bad.ply", bytes);
    EXPECT_THROW(
        {
          MeshDiscard sink;
          PlyStreamReader(file).read(sink);
        },
        InputError);
  };
  refuse("");
  refuse("ply\n");
  refuse(good.substr(0, good.size() - 1));
  refuse(good + "x");
  std::string bad = good;
  bad.back() = '\x7f';  // an index far behind the vertices
  refuse(bad);
  bad = good;
  bad[bad.size() - 13] = 4;  // a polygon
  refuse(bad);
  bad = good;
  bad.replace(bad.find("end_header\n") + 11, 4, "\xff\xff\xff\x7f");  // not a number
  refuse(bad);
  bad = good;
  bad.replace(bad.find("float x"), 7, "float q");
  refuse(bad);
  refuse("ply\nformat ascii 1.0\nelement vertex 0\nelement face 0\nend_header\n");
  refuse(
      "ply\nformat binary_little_endian 1.0\nelement vertex 9999999999999\nproperty float x\nproperty float "
      "y\nproperty float z\nelement face 0\nproperty list uchar uint vertex_indices\nend_header\n");
  EXPECT_THROW(PlyStreamReader(folder / "none.ply"), InputError);
}

}  // namespace
}  // namespace astrolith
