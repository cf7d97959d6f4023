#include "geometry/io/ply_stream_writer.h"

#include <algorithm>

#include "geometry/mesh_normals.h"
#include "numerics/errors.h"
#include "tests/support/meshes.h"
#include "tests/support/scratch_folder.h"

namespace astrolith {
namespace {

using namespace testing;

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
  const std::string bytes = text_of(folder / "whole.ply");
  EXPECT_TRUE(text_of(folder / "streamed.ply") == bytes);
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
    EXPECT_TRUE(text_of(folder / "streamed.ply") == text_of(folder / "whole.ply"));
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
