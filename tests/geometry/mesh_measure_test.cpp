#include <vector>

#include "geometry/mesh_measure.h"
#include "geometry/mesh_topology.h"
#include "geometry/wound_surface.h"
#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "tests/support/meshes.h"

namespace astrolith {
namespace {

using namespace testing;

TEST(MeshMeasure, CubeFarFromTheOrigin) {
  const Vec3d corner{1e6, -2e6, 5e5};
  const TriangleMesh mesh = cube(2.0, corner);
  EXPECT_NEAR(surface_area(mesh), 24, 1e-9);
  EXPECT_NEAR(volume(mesh), 8, 1e-9);
  EXPECT_NEAR(volume(reversed(mesh)), -8, 1e-9);
  EXPECT_NEAR(norm(volume_centroid(mesh) - corner - Vec3d{1, 1, 1}), 0, 1e-8);
  EXPECT_NEAR(norm(surface_centroid(mesh) - corner - Vec3d{1, 1, 1}), 0, 1e-8);
}

// The polyhedra are inscribed, so that the error falls fourfold with each subdivision.
TEST(MeshMeasure, SphereConvergesToSecondOrder) {
  const double r = 3, v = 4.0 / 3 * std::numbers::pi * r * r * r, a = 4 * std::numbers::pi * r * r;
  const TriangleMesh coarse = icosphere(3, r), fine = icosphere(4, r);
  EXPECT_NEAR((v - volume(coarse)) / (v - volume(fine)), 4, 0.05);
  EXPECT_NEAR((a - surface_area(coarse)) / (a - surface_area(fine)), 4, 0.05);
  EXPECT_NEAR(volume(fine) / v, 1, 3e-3);
}

TEST(MeshMeasure, TorusAgainstPappus) {
  const TriangleMesh mesh = torus(2, 0.5, 400, 200);
  EXPECT_NEAR(volume(mesh) / (2 * std::numbers::pi * std::numbers::pi * 2 * 0.25), 1, 5e-4);
  EXPECT_NEAR(surface_area(mesh) / (4 * std::numbers::pi * std::numbers::pi * 2 * 0.5), 1, 5e-4);
}

TEST(MeshMeasure, CentroidOfTwoSpheresOfDifferentSize) {
  const TriangleMesh mesh = joined(icosphere(3, 1, {-3, 0, 0}), icosphere(3, 2, {3, 0, 0}));
  EXPECT_NEAR(volume_centroid(mesh).x, (-3 * 1 + 3 * 8) / 9.0, 1e-9);
  EXPECT_NEAR(surface_centroid(mesh).x, (-3 * 1 + 3 * 4) / 5.0, 1e-9);
}

TEST(MeshNormals, PointOutwards) {
  const TriangleMesh mesh = icosphere(3, 2, {1, 1, 1});
  const auto normals = vertex_normals(mesh);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    ASSERT_NEAR(norm(normals[i] - normalized(mesh.vertices[i] - Vec3d{1, 1, 1})), 0, 6e-3);
  }
}

// The normals must not depend on how the faces of a cube are split; the angles as weights ensure this.
TEST(MeshNormals, CubeCornersAreDiagonal) {
  const TriangleMesh mesh = cube(2.0, {-1, -1, -1});
  const auto normals = vertex_normals(mesh);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    EXPECT_NEAR(norm(normals[i] - normalized(mesh.vertices[i])), 0, 1e-12);
  }
}

TEST(MeshNormals, TriangleWithoutAreaHasNone) {
  const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}, {}};
  EXPECT_EQ(triangle_normals(mesh)[0], Vec3d{});
  EXPECT_EQ(vertex_normals(mesh)[0], Vec3d{});
}

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

TEST(OrientFaces, RepairsRandomFlips) {
  for (const TriangleMesh& mesh : {icosphere(3, 2, {9, 9, 9}), torus(2, 0.5), two_spheres(2, 1, 5)}) {
    TriangleMesh flipped = mesh;
    CounterRandom random(3);
    for (Triangle& t : flipped.triangles) {
      if (random.uniform() < 0.4) std::swap(t[1], t[2]);
    }
    EXPECT_FALSE(analyze_topology(flipped).oriented);
    const TriangleMesh repaired = orient_faces(flipped);
    EXPECT_TRUE(analyze_topology(repaired).oriented);
    EXPECT_NEAR(volume(repaired), volume(mesh), 1e-9);
    EXPECT_NEAR(volume(orient_faces(reversed(mesh))), volume(mesh), 1e-9);
  }
}

TEST(OrientFaces, LeavesAGoodMeshAlone) {
  const TriangleMesh mesh = torus(3, 1);
  EXPECT_TRUE(orient_faces(mesh).triangles == mesh.triangles);
}

TEST(TriangleQuality, KnownTriangles) {
  EXPECT_NEAR(triangle_quality({0, 0, 0}, {1, 0, 0}, {0.5f, 0.8660254f, 0}), 1.0, 1e-6);
  EXPECT_NEAR(triangle_quality({5, 5, 5}, {5, 9, 5}, {5, 5, 9}), 0.8660254, 1e-6);  // right and isosceles
  EXPECT_EQ(triangle_quality({0, 0, 0}, {1, 1, 1}, {3, 3, 3}), 0.0f);
  EXPECT_EQ(triangle_quality({1, 2, 3}, {1, 2, 3}, {1, 2, 3}), 0.0f);
}

TEST(TriangleQuality, FiguresOfAMesh) {
  // 198 right triangles, and two without area.
  const std::vector<MeshVertex> vertices{{{0, 0, 0}, {}}, {{1, 0, 0}, {}}, {{0, 1, 0}, {}}, {{2, 0, 0}, {}}};
  std::vector<Triangle> triangles(198, Triangle{0, 1, 2});
  triangles.insert(triangles.begin() + 60, 2, Triangle{0, 1, 3});
  const QualityFigures figures = mesh_quality(vertices, triangles);
  EXPECT_NEAR(figures.first_percentile, 0.8660254, 1e-6);
  EXPECT_NEAR(figures.mean, 0.99 * 0.8660254, 1e-6);
  triangles.push_back({0, 1, 3});
  EXPECT_EQ(mesh_quality(vertices, triangles).first_percentile, 0.0);
  EXPECT_EQ(mesh_quality({}, {}).mean, 0.0);
}

}  // namespace
}  // namespace astrolith
