#include "geometry/atlas/texture_coordinates.h"

#include "geometry/atlas/texture_atlas.h"
#include "geometry/mesh_measure.h"
#include "tests/support/meshes.h"

namespace astrolith {
namespace {

using namespace testing;

Vec3d direction(const VertexTangent& t) { return {double{t[0]}, double{t[1]}, double{t[2]}}; }

// A square whose image is turned by a quarter: u runs along +y, and the image's top is at -x.
TEST(VertexTangents, RunAlongUOfASquare) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.normals.assign(4, {0, 0, 1});
  TextureCoordinates turned{{0, 1, 2, 3}, {{0, 0}, {0, 1}, {1, 1}, {1, 0}}, mesh.triangles};
  for (const VertexTangent& t : vertex_tangents(mesh, turned)) EXPECT_EQ(t, (VertexTangent{0, 1, 0, 1}));
  TextureCoordinates mirrored{{0, 1, 2, 3}, {{0, 1}, {0, 0}, {1, 0}, {1, 1}}, mesh.triangles};
  for (const VertexTangent& t : vertex_tangents(mesh, mirrored)) EXPECT_EQ(t, (VertexTangent{0, 1, 0, -1}));
}

TEST(VertexTangents, OfAChartAreUnitInThePlaneOfTheNormal) {
  TriangleMesh mesh = icosphere(3);
  mesh.normals = vertex_normals(mesh);
  const TextureCoordinates made = make_texture_atlas(mesh, 256, "test").coordinates;
  const std::vector<VertexTangent> tangents = vertex_tangents(mesh, made);
  ASSERT_EQ(tangents.size(), made.uv.size());
  for (std::size_t w = 0; w < tangents.size(); ++w) {
    ASSERT_NEAR(norm(direction(tangents[w])), 1.0, 1e-6);
    ASSERT_NEAR(dot(direction(tangents[w]), mesh.normals[made.mesh_vertex[w]]), 0.0, 1e-6);
    ASSERT_EQ(tangents[w][3], 1.0f);
  }
}

}  // namespace
}  // namespace astrolith
