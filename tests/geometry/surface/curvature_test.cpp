#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include "geometry/io/mesh_io.h"
#include "geometry/mesh_measure.h"
#include "geometry/mesh_topology.h"
#include "geometry/surface/sample_curvature.h"
#include "numerics/errors.h"
#include "tests/support/data.h"
#include "tests/support/meshes.h"

namespace astrolith {
namespace {

using namespace testing;

double total_gaussian(const VertexCurvature& c) {
  return std::inner_product(c.gaussian.begin(), c.gaussian.end(), c.area.begin(), 0.0);
}
double sum(const std::vector<double>& v) { return std::accumulate(v.begin(), v.end(), 0.0); }

// A double torus: unit cubes in a block of five by three by one, two of which are missing.
TriangleMesh double_torus() {
  const auto solid = [](int x, int y, int z) {
    return x >= 0 && x < 5 && y >= 0 && y < 3 && z == 0 && !(y == 1 && (x == 1 || x == 3));
  };
  TriangleMesh mesh;
  std::map<std::array<int, 3>, std::uint32_t> index;
  const auto corner = [&](int x, int y, int z) {
    const auto [it, added] = index.try_emplace({x, y, z}, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (added) mesh.vertices.push_back({1.0 * x, 1.0 * y, 1.0 * z});
    return it->second;
  };
  for (int x = 0; x < 5; ++x) {
    for (int y = 0; y < 3; ++y) {
      if (!solid(x, y, 0)) continue;
      const TriangleMesh box = cube(1.0, {1.0 * x, 1.0 * y, 0});
      for (const Triangle& t : box.triangles) {
        const Vec3d &a = box.vertices[t[0]], &b = box.vertices[t[1]], &c = box.vertices[t[2]];
        const Vec3d n = cross(b - a, c - a);
        if (solid(x + static_cast<int>(n.x), y + static_cast<int>(n.y), static_cast<int>(n.z))) continue;
        const auto at = [&](const Vec3d& p) {
          return corner(static_cast<int>(p.x), static_cast<int>(p.y), static_cast<int>(p.z));
        };
        mesh.triangles.push_back({at(a), at(b), at(c)});
      }
    }
  }
  return mesh;
}

TEST(Curvature, GaussAndBonnet) {
  const auto expect_total = [](const TriangleMesh& mesh, int euler) {
    const VertexCurvature c = vertex_curvature(mesh);
    EXPECT_TRUE(c.left_out.empty());
    EXPECT_NEAR(total_gaussian(c), 2 * std::numbers::pi * euler, 1e-9);
    EXPECT_NEAR(sum(c.area) / surface_area(mesh), 1, 1e-12);
  };
  expect_total(tetrahedron(), 2);
  expect_total(cube(3.0), 2);
  expect_total(icosphere(3), 2);
  expect_total(torus(2, 0.5, 31, 17), 0);
  expect_total(two_spheres(2, 1, 3), 4);
  expect_total(double_torus(), -2);
}

TEST(Curvature, GaussAndBonnetOnRealBodies) {
  for (const char* name : {"eros_gaskell_49k.ply", "itokawa_gaskell_12k.ply", "kleopatra_radar_4k.ply",
                           "arrokoth_porter2024_10k_two_components.ply"}) {
    const auto file = shared_shape(name);
    ASTROLITH_SKIP_WITHOUT(file);
    const TriangleMesh mesh = read_mesh(file);
    const VertexCurvature c = vertex_curvature(mesh);
    EXPECT_TRUE(c.left_out.empty()) << name;
    const auto euler = static_cast<double>(analyze_topology(mesh).euler_characteristic);
    EXPECT_NEAR(total_gaussian(c), 2 * std::numbers::pi * euler, 1e-8) << name;
  }
}

TEST(Curvature, SphereOfAnySize) {
  for (const double r : {1e-3, 1.0, 250.0}) {
    const TriangleMesh mesh = icosphere(4, r, {3 * r, 0, 0});
    const VertexCurvature c = vertex_curvature(mesh);
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      ASSERT_NEAR(c.gaussian[v] * r * r, 1, 0.02);
      ASSERT_NEAR(c.mean[v] * r, 1, 0.01);
    }
  }
}

// On a torus K = cos v / (r (R + r cos v)) and H = (R + 2 r cos v) / (2 r (R + r cos v)). K has both signs,
// and H falls to (R - 2 r) / (2 r (R - r)) on the inner side.
TEST(Curvature, Torus) {
  const double big = 2, small = 0.7;
  const int rows = 120;
  const TriangleMesh mesh = torus(big, small, 240, rows);
  const VertexCurvature c = vertex_curvature(mesh);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const double cosine = std::cos(2 * std::numbers::pi * static_cast<double>(i % rows) / rows),
                 rho = big + small * cosine;
    ASSERT_NEAR(c.gaussian[i], cosine / (small * rho), 2e-3);
    ASSERT_NEAR(c.mean[i], (big + 2 * small * cosine) / (2 * small * rho), 2e-3);
  }
}

TEST(Curvature, HollowsAreNegative) {
  const VertexCurvature c = vertex_curvature(reversed(icosphere(2)));
  EXPECT_LT(*std::max_element(c.mean.begin(), c.mean.end()), -0.9);
  EXPECT_GT(*std::min_element(c.gaussian.begin(), c.gaussian.end()), 0.9);
}

TEST(Curvature, BoundaryAndUnusedVerticesAreLeftOut) {
  const TriangleMesh mesh = open_cap(3);
  const VertexCurvature c = vertex_curvature(mesh);
  ASSERT_FALSE(c.left_out.empty());
  EXPECT_TRUE(std::is_sorted(c.left_out.begin(), c.left_out.end()));
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    const bool out = std::binary_search(c.left_out.begin(), c.left_out.end(), v);
    EXPECT_EQ(c.gaussian[v] == 0, out);
    EXPECT_TRUE(out || std::fabs(c.gaussian[v] - 1) < 0.05);
    EXPECT_TRUE(out || mesh.vertices[v].z >= 0);
  }
}

TEST(Curvature, NonManifoldPartsAreCutOut) {
  // Two octahedra share a tip, one of them shares an edge with a third, and one face is turned over.
  TriangleMesh mesh = joined(octahedron(), octahedron());
  for (Triangle& t : mesh.triangles) std::replace(t.begin(), t.end(), 6u, 0u);
  EXPECT_EQ(vertex_curvature(mesh).left_out, (std::vector<std::uint32_t>{0, 6}));
  mesh.vertices.push_back({5, 5, 5});
  mesh.triangles.push_back({1, 3, 12});
  EXPECT_EQ(vertex_curvature(mesh).left_out, (std::vector<std::uint32_t>{0, 1, 3, 6, 12}));
  TriangleMesh turned = octahedron();
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  EXPECT_EQ(vertex_curvature(turned).left_out, (std::vector<std::uint32_t>{0, 2, 4}));
}

TEST(Curvature, RepeatedAndDegenerateTriangles) {
  TriangleMesh mesh = octahedron();
  mesh.triangles.push_back({0, 2, 4});  // a copied triangle, so that its edges have three
  mesh.triangles.push_back({5, 5, 1});
  EXPECT_EQ(vertex_curvature(mesh).left_out, (std::vector<std::uint32_t>{0, 2, 4}));
  mesh.vertices.push_back({0, 0, 0});
  const TriangleMesh flat{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {2, 1, 0}}, {}};
  EXPECT_EQ(vertex_curvature(flat).left_out.size(), 4u);
  EXPECT_TRUE(vertex_curvature({}).left_out.empty());
  EXPECT_THROW(vertex_curvature({{{0, 0, 0}}, {{0, 1, 2}}, {}}), InputError);
}

double mean_value(const std::vector<double>& v) {
  double sum = 0;
  for (const double x : v) sum += x;
  return sum / static_cast<double>(v.size());
}

TEST(SampleCurvature, SphereOfAnySizeAndTriangulation) {
  for (const double r : {1e-3, 250.0}) {
    for (const int subdivisions : {2, 4}) {
      const TriangleMesh mesh = icosphere(subdivisions, r, {5 * r, 0, 0});
      const SampleCurvature c =
          sample_curvature(mesh, sample_poisson_disk(mesh, 300, 1, SampleNormals::triangle), 0.1 * r);
      EXPECT_EQ(c.undefined, 0);
      EXPECT_EQ(c.vertices_left_out, 0);
      for (const double k : c.gaussian) ASSERT_NEAR(k * r * r, 1, 0.06);
    }
  }
}

// The sphere has bumps as large as its triangles. K at the vertices is noise a thousand times the curvature
// of the sphere; the mean of K in a ball is not.
TEST(SampleCurvature, FineBumpsAverageOut) {
  TriangleMesh mesh = icosphere(5);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) mesh.vertices[i] *= i % 2 == 0 ? 1.004 : 0.996;
  const SurfaceSamples s = sample_poisson_disk(mesh, 300, 1);
  double fine = 0, coarse = 0;
  for (const double k : sample_curvature(mesh, s, 0).gaussian) fine += (k - 1) * (k - 1) / 300;
  for (const double k : sample_curvature(mesh, s, 0.25).gaussian) coarse += (k - 1) * (k - 1) / 300;
  EXPECT_GT(std::sqrt(fine), 10);
  EXPECT_LT(std::sqrt(coarse), 0.5);
}

TEST(SampleCurvature, TwoSidesOfAThinPartStayApart) {
  // A flat lens. Without a test of the normals the ball would hold vertices of both sides, and the mean would
  // still be right. One side is therefore coarse: its vertices would be missing from the count.
  const TriangleMesh ball = icosphere(4);
  TriangleMesh shell = joined(ball, reversed(icosphere(4, 0.97)));
  const SurfaceSamples s = sample_poisson_disk(shell, 400, 2);
  const SampleCurvature c = sample_curvature(shell, s, 0.1);
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    const double r = norm(s.points[i]) > 0.985 ? 1.0 : 0.97;
    ASSERT_NEAR(c.gaussian[i] * r * r, 1, 0.05);
  }
}

TEST(SampleCurvature, OpenMeshesSayWhatIsLeftOut) {
  const TriangleMesh mesh = open_cap(4);
  const SampleCurvature c = sample_curvature(mesh, sample_poisson_disk(mesh, 500, 1), 0.1);
  EXPECT_GT(c.vertices_left_out, 10);
  EXPECT_NEAR(mean_value(c.gaussian), 1, 0.02);
  const TriangleMesh lone{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {}};
  const SampleCurvature none = sample_curvature(lone, sample_surface(lone, 10, 1), 0.1);
  EXPECT_EQ(none.undefined, 10);
  EXPECT_EQ(none.vertices_left_out, 3);
  EXPECT_EQ(none.gaussian, std::vector<double>(10, 0.0));
}

// The curvature from points and normals alone, against K = cos v / (r (R + r cos v)).
TEST(PointCurvature, Torus) {
  const double big = 2, small = 0.7;
  const TriangleMesh mesh = torus(big, small, 200, 100);
  const SurfaceSamples s = sample_poisson_disk(mesh, 4000, 3, SampleNormals::interpolated);
  const SampleCurvature c = point_curvature(s.points, s.normals);
  EXPECT_EQ(c.undefined, 0);
  double squares = 0;
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    const double rho = std::hypot(s.points[i].x, s.points[i].y), cosine = (rho - big) / small;
    squares += std::pow(c.gaussian[i] - cosine / (small * rho), 2) / 4000;
  }
  EXPECT_LT(std::sqrt(squares), 0.04);  // the values lie between -1.1 and 0.53
}

TEST(PointCurvature, WhatDoesNotDetermineAQuadric) {
  const std::vector<Vec3d> few = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, up(3, Vec3d{0, 0, 1});
  EXPECT_EQ(point_curvature(few, up).undefined, 3);
  std::vector<Vec3d> line, normals(50, Vec3d{0, 0, 1}), same(50, Vec3d{1, 2, 3});
  for (int i = 0; i < 50; ++i) line.push_back({0.1 * i, 0, 0});
  EXPECT_EQ(point_curvature(line, normals).undefined, 50);
  EXPECT_EQ(point_curvature(same, normals).undefined, 50);
  EXPECT_TRUE(point_curvature({}, {}).gaussian.empty());
}

}  // namespace
}  // namespace astrolith
