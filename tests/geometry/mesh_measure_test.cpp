#include "geometry/mesh_measure.h"

#include "geometry/mesh_normals.h"
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

}  // namespace
}  // namespace astrolith
