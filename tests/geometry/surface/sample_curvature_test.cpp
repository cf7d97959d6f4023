#include "geometry/surface/sample_curvature.h"

#include <cmath>

#include "tests/support/meshes.h"

namespace astrolith {
namespace {

using namespace testing;

double mean_of(const std::vector<double>& v) {
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
  EXPECT_NEAR(mean_of(c.gaussian), 1, 0.02);
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
