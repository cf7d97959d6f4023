#include <fstream>

#include "geometry/io/mesh_io.h"
#include "geometry/mesh_measure.h"
#include "geometry/mesh_topology.h"
#include "numerics/errors.h"
#include "tests/support/meshes.h"
#include "tests/support/scratch_folder.h"

namespace astrolith {
namespace {

using namespace testing;

const MeshFileInfo kKilometres{"km", "", "", {}};

TriangleMesh lumpy_body() {
  TriangleMesh mesh = icosphere(5);
  for (Vec3d& p : mesh.vertices) {
    p = p * (1.0 + 0.1 * std::sin(5 * p.x) * std::cos(4 * p.y));
    p = {2 * p.x + 7, p.y - 1, 1.3 * p.z};
  }
  return mesh;
}

TEST(WriteIcq, ReadsBackAsTheSameShape) {
  const ScratchFolder folder;
  const TriangleMesh mesh = lumpy_body();
  write_mesh(mesh, folder / "a.icq", kKilometres);
  const TriangleMesh back = read_mesh(folder / "a.icq");
  const MeshTopology topology = analyze_topology(back);
  EXPECT_TRUE(topology.closed && topology.manifold && topology.oriented);
  EXPECT_EQ(topology.genus, 0);
  // 20,480 triangles: Q = 41.
  EXPECT_EQ(back.vertices.size(), 6u * 41 * 41 + 2);
  EXPECT_NEAR(volume(back) / volume(mesh), 1, 2e-3);
  EXPECT_LT(norm(volume_centroid(back) - volume_centroid(mesh)), 2e-3);
}

// A reader after the description of the format: Q, and six faces of (Q+1)^2 points, i running fastest. The
// edges that Gaskell's document calls common are the same points to the last digit.
TEST(WriteIcq, CommonEdgesAreThoseOfTheFormat) {
  const ScratchFolder folder;
  write_mesh(lumpy_body(), folder / "a.icq", kKilometres);
  std::ifstream file(folder / "a.icq");
  int q = 0;
  file >> q;
  ASSERT_EQ(q, 41);
  std::vector<Vec3d> points;
  for (Vec3d p; file >> p.x >> p.y >> p.z;) points.push_back(p);
  ASSERT_EQ(points.size(), 6u * 42 * 42);
  const auto v = [&](int i, int j, int face) {
    return points[static_cast<std::size_t>(((face - 1) * (q + 1) + j) * (q + 1) + i)];
  };
  for (int k = 0; k <= q; ++k) {
    EXPECT_TRUE(v(k, q, 6) == v(q - k, q, 4));
    EXPECT_TRUE(v(k, 0, 6) == v(k, q, 2));
    EXPECT_TRUE(v(k, 0, 5) == v(q, q - k, 1));
    EXPECT_TRUE(v(k, 0, 4) == v(q - k, 0, 1));
    EXPECT_TRUE(v(k, 0, 3) == v(0, k, 1));
    EXPECT_TRUE(v(k, 0, 2) == v(k, q, 1));
    EXPECT_TRUE(v(q, k, 6) == v(k, q, 5));
    EXPECT_TRUE(v(q, k, 5) == v(0, k, 4));
    EXPECT_TRUE(v(q, k, 4) == v(0, k, 3));
    EXPECT_TRUE(v(q, k, 3) == v(0, k, 2));
    EXPECT_TRUE(v(0, k, 6) == v(q - k, q, 3));
    EXPECT_TRUE(v(0, k, 5) == v(q, k, 2));
  }
}

// Points of the cube whose directions run along edges and through vertices of the mesh.
TEST(WriteIcq, ACubeIsFoundAlongAllDirections) {
  const ScratchFolder folder;
  TriangleMesh mesh = cube(2.0, {-1, -1, -1});
  for (int i = 0; i < 3; ++i) mesh = subdivided(mesh);
  write_mesh(mesh, folder / "a.icq", kKilometres);
  const TriangleMesh back = read_mesh(folder / "a.icq");
  EXPECT_NEAR(volume(back), 8.0, 1e-9);
}

TEST(WriteIcq, RefusesOtherBodies) {
  const ScratchFolder folder;
  for (const TriangleMesh& mesh : {torus(3, 1), two_spheres(2, 1, 4), open_cap(2)}) {
    EXPECT_THROW(write_mesh(mesh, folder / "a.icq", kKilometres), InputError);
    EXPECT_FALSE(std::filesystem::exists(folder / "a.icq"));
  }
}

TEST(WritePlate, RoundTripIsExact) {
  const ScratchFolder folder;
  const TriangleMesh mesh = icosphere(3, 1.0 / 3, {1e-7, 1e5, 0});
  write_mesh(mesh, folder / "a.tab", {"km", "", "", {}});
  const TriangleMesh back = read_mesh(folder / "a.tab");
  EXPECT_TRUE(back.vertices == mesh.vertices);
  EXPECT_TRUE(back.triangles == mesh.triangles);
}

// A reader after the description of the format.
TEST(WritePlate, RowsAreNumberedFromOne) {
  const ScratchFolder folder;
  const TriangleMesh mesh = tetrahedron();
  write_mesh(mesh, folder / "a.tab", {"km", "", "", {}});
  std::ifstream file(folder / "a.tab");
  std::size_t count = 0, number = 0;
  ASSERT_TRUE(file >> count);
  ASSERT_EQ(count, 4u);
  for (std::size_t i = 1; i <= count; ++i) {
    Vec3d p;
    ASSERT_TRUE(file >> number >> p.x >> p.y >> p.z);
    EXPECT_EQ(number, i);
    EXPECT_TRUE(p == mesh.vertices[i - 1]);
  }
  ASSERT_TRUE(file >> count);
  ASSERT_EQ(count, 4u);
  for (std::size_t i = 1; i <= count; ++i) {
    std::uint32_t a = 0, b = 0, c = 0;
    ASSERT_TRUE(file >> number >> a >> b >> c);
    EXPECT_EQ(number, i);
    EXPECT_TRUE((mesh.triangles[i - 1] == Triangle{a - 1, b - 1, c - 1}));
  }
}

}  // namespace
}  // namespace astrolith
