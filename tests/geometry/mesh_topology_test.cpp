#include "geometry/mesh_topology.h"

#include "numerics/errors.h"
#include "tests/support/meshes.h"

namespace astrolith {
namespace {

using namespace testing;

void expect_closed_surface(const MeshTopology& t, int components, int genus) {
  EXPECT_TRUE(t.closed && t.manifold && t.oriented);
  EXPECT_EQ(t.components, components);
  EXPECT_EQ(t.genus, genus);
  EXPECT_EQ(t.euler_characteristic, 2 * components - 2 * genus);
  EXPECT_EQ(t.boundary_edges + t.non_manifold_edges + t.non_manifold_vertices + t.misoriented_edges, 0);
  EXPECT_EQ(t.degenerate_triangles + t.unused_vertices, 0);
}

TEST(MeshTopology, ClosedSurfaces) {
  expect_closed_surface(analyze_topology(tetrahedron()), 1, 0);
  expect_closed_surface(analyze_topology(cube()), 1, 0);
  expect_closed_surface(analyze_topology(icosphere(3)), 1, 0);
  expect_closed_surface(analyze_topology(torus(2, 0.5)), 1, 1);
  expect_closed_surface(analyze_topology(two_spheres(2, 1, 3)), 2, 0);
  expect_closed_surface(analyze_topology(joined(torus(2, 0.5), joined(icosphere(1), torus(3, 0.2)))), 3, 2);
}

TEST(MeshTopology, OpenCapHasOneLoopOfBoundary) {
  const MeshTopology t = analyze_topology(open_cap(2));
  EXPECT_FALSE(t.closed);
  EXPECT_TRUE(t.manifold && t.oriented);
  EXPECT_EQ(t.euler_characteristic, 1);  // a disk
  EXPECT_EQ(t.genus, -1);
  EXPECT_GT(t.boundary_edges, 3);
  EXPECT_GT(t.unused_vertices, 0);
}

TEST(MeshTopology, OneFaceTurnedOver) {
  TriangleMesh mesh = octahedron();
  std::swap(mesh.triangles[3][0], mesh.triangles[3][1]);
  const MeshTopology t = analyze_topology(mesh);
  EXPECT_EQ(t.misoriented_edges, 3);
  EXPECT_FALSE(t.oriented);
  EXPECT_TRUE(t.closed && t.manifold);
  EXPECT_TRUE(analyze_topology(reversed(octahedron())).oriented);
}

TEST(MeshTopology, TwoBodiesThatTouchInAPoint) {
  TriangleMesh mesh = joined(octahedron(), octahedron());
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& v : t) v = v == 6 ? 0 : v;  // the second body shares a tip with the first
  }
  const MeshTopology t = analyze_topology(mesh);
  EXPECT_EQ(t.non_manifold_vertices, 1);
  EXPECT_EQ(t.non_manifold_edges, 0);
  EXPECT_EQ(t.components, 1);
  EXPECT_EQ(t.unused_vertices, 1);
  EXPECT_TRUE(t.closed && t.oriented);
  EXPECT_FALSE(t.manifold);
}

TEST(MeshTopology, ThreePagesOfABook) {
  const TriangleMesh mesh{
      {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}}, {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}}, {}};
  const MeshTopology t = analyze_topology(mesh);
  EXPECT_EQ(t.non_manifold_edges, 1);
  EXPECT_EQ(t.non_manifold_vertices, 2);
  EXPECT_EQ(t.misoriented_edges, 1);
  EXPECT_EQ(t.boundary_edges, 6);
  EXPECT_EQ(t.components, 1);
}

TEST(MeshTopology, DegenerateTrianglesChangeNothingElse) {
  TriangleMesh mesh = octahedron();
  mesh.triangles.push_back({1, 1, 2});
  const MeshTopology t = analyze_topology(mesh);
  EXPECT_EQ(t.degenerate_triangles, 1);
  EXPECT_EQ(t.genus, 0);
}

TEST(MeshTopology, ComponentsOfTriangles) {
  TriangleMesh mesh = joined(tetrahedron(), joined(octahedron(), tetrahedron()));
  std::swap(mesh.triangles[0], mesh.triangles[4]);
  const auto c = triangle_components(mesh);
  EXPECT_EQ(c, (std::vector<std::uint32_t>{0, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0, 2, 2, 2, 2}));
}

TEST(MeshTopology, EmptyMeshAndWrongIndex) {
  const MeshTopology t = analyze_topology({});
  EXPECT_FALSE(t.closed || t.manifold);
  EXPECT_EQ(t.components, 0);
  EXPECT_THROW(analyze_topology({{{0, 0, 0}}, {{0, 0, 1}}, {}}), InputError);
}

}  // namespace
}  // namespace astrolith
