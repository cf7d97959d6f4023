#include <algorithm>
#include <random>

#include "geometry/io/ply_stream_reader.h"
#include "geometry/io/ply_stream_writer.h"
#include "geometry/mesh_measure.h"
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
  const std::string good = read_text(folder / "a.ply");
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

std::vector<MeshVertex> as_floats(const TriangleMesh& mesh) {
  const auto to_float = [](const Vec3d& v) {
    return Vec3f{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
  };
  std::vector<MeshVertex> vertices;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    vertices.push_back({to_float(mesh.vertices[i]), to_float(mesh.normals[i])});
  }
  return vertices;
}

TriangleMesh body() {
  TriangleMesh mesh = torus(2, 0.7);
  mesh.normals = vertex_normals(mesh);
  return mesh;
}

// Writes vertices and triangles in portions that grow with the index, triangles after their vertices.
void stream(const TriangleMesh& mesh, std::size_t portion, PlyStreamWriter& writer) {
  const std::vector<MeshVertex> vertices = as_floats(mesh);
  const std::span<const MeshVertex> all(vertices);
  const std::span<const Triangle> triangles(mesh.triangles);
  std::size_t next_triangle = 0;
  for (std::size_t i = 0; i < all.size(); i += portion) {
    const std::size_t n = std::min(portion, all.size() - i);
    writer.add_vertices(all.subspan(i, n));
    while (next_triangle < triangles.size() && *std::ranges::max_element(triangles[next_triangle]) < i + n) {
      writer.add_triangles(triangles.subspan(next_triangle++, 1));
    }
  }
  EXPECT_EQ(next_triangle, triangles.size());
}

// Colours that tell the vertices apart.
void paint(std::span<const MeshVertex> vertices, std::span<VertexColor> colors) {
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const auto part = [](float v) { return static_cast<std::uint8_t>(128.0f + 40.0f * v); };
    const Vec3f& p = vertices[i].position;
    colors[i] = {part(p.x), part(p.y), part(p.z)};
  }
}

TEST(PlyStreamWriter, StreamedColoursAreThoseOfWriteMesh) {
  const ScratchFolder folder;
  TriangleMesh mesh = body();
  const std::vector<MeshVertex> vertices = as_floats(mesh);
  mesh.colors.resize(vertices.size());
  paint(vertices, mesh.colors);
  const MeshFileInfo info{"km", "body-fixed", ""};
  write_mesh(mesh, folder / "whole.ply", info);
  PlyStreamWriter writer(folder / "streamed.ply", info, {}, paint);
  stream(mesh, 7, writer);
  writer.finish();
  const std::string bytes = read_text(folder / "whole.ply");
  EXPECT_TRUE(read_text(folder / "streamed.ply") == bytes);
  EXPECT_NE(bytes.find("property float nz\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"),
            std::string::npos);
  const std::size_t first = bytes.find("end_header\n") + 11 + 6 * sizeof(float);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(static_cast<std::uint8_t>(bytes[first + k]), mesh.colors[0][k]);
  }
  EXPECT_EQ(read_mesh(folder / "whole.ply").triangles, mesh.triangles);
}

TEST(PlyStreamWriter, BytesDoNotDependOnPortionsAndEqualThoseOfWriteMesh) {
  const ScratchFolder folder;
  const TriangleMesh mesh = body();
  const MeshFileInfo info{"km", "body-fixed", ""};
  write_mesh(mesh, folder / "whole.ply", info);
  for (const std::size_t portion : {1, 7, 1000, 100000}) {
    PlyStreamWriter writer(folder / "streamed.ply", info);
    stream(mesh, portion, writer);
    writer.finish();
    EXPECT_EQ(writer.num_vertices(), mesh.vertices.size());
    EXPECT_EQ(writer.num_triangles(), mesh.triangles.size());
    EXPECT_TRUE(read_text(folder / "streamed.ply") == read_text(folder / "whole.ply"));
  }
}

TEST(PlyStreamWriter, NothingAppearsWithoutFinish) {
  const ScratchFolder folder;
  {
    PlyStreamWriter writer(folder / "a.ply", {});
    stream(body(), 100, writer);
    EXPECT_FALSE(std::filesystem::exists(folder / "a.ply"));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(PlyStreamWriter, TrianglesNameOnlyVerticesAlreadyGiven) {
  const ScratchFolder folder;
  PlyStreamWriter writer(folder / "a.ply", {});
  const std::vector<MeshVertex> three(3);
  writer.add_vertices(three);
  const std::vector<Triangle> good{{0, 1, 2}}, bad{{1, 2, 3}};
  writer.add_triangles(good);
  EXPECT_THROW(writer.add_triangles(bad), WorkError);
}

TEST(PlyStreamWriter, AMissingFolderIsTheUsersError) {
  EXPECT_THROW(PlyStreamWriter("/no/such/folder/a.ply", {}), InputError);
}

}  // namespace
}  // namespace astrolith
