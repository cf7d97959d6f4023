#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string>

#include "descriptor/spectrum/laplacian_spectrum.h"
#include "geometry/surface/mesh_sampling.h"
#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"
#include "tests/support/meshes.h"
#include "tests/support/refusal.h"

namespace astrolith {
namespace {

using std::numbers::pi;

// The eigenvalues of a sphere: l (l + 1) / R^2, each 2 l + 1 times, times the area 4 pi R^2.
void expect_sphere(const std::vector<double>& eigenvalues, double tolerance) {
  std::size_t i = 0;
  for (int l = 1; i < eigenvalues.size(); ++l) {
    for (int m = 0; m < 2 * l + 1 && i < eigenvalues.size(); ++m, ++i) {
      EXPECT_NEAR(eigenvalues[i] / (4 * std::numbers::pi * l * (l + 1)), 1, tolerance)
          << "l = " << l << ", m = " << m;
    }
  }
}

TEST(LaplacianSpectrum, OfASphereIsThatOfTheSphericalHarmonics) {
  const LaplacianSpectrum s = laplacian_spectrum(testing::icosphere(5, 3.0), 35);
  ASSERT_EQ(s.eigenvalues.size(), 35u);
  EXPECT_NEAR(s.area, 36 * std::numbers::pi, 0.1);
  EXPECT_EQ(s.left_out_triangles, 0);
  expect_sphere(s.eigenvalues, 0.004);
}

// The error of linear elements falls with the squared edge length.
TEST(LaplacianSpectrum, ConvergesWithTheSquaredEdgeLength) {
  const auto error = [](int subdivisions) {
    return std::fabs(
        laplacian_spectrum(testing::icosphere(subdivisions), 8).eigenvalues[7] / (24 * std::numbers::pi) - 1);
  };
  EXPECT_NEAR(error(3) / error(4), 4, 0.5);
}

// The eigenvalues of a rectangle a x b with free edges: pi^2 ((m / a)^2 + (n / b)^2).
TEST(LaplacianSpectrum, OfARectangleHasFreeEdges) {
  TriangleMesh mesh;
  const int columns = 60, rows = 30;
  const double a = 2, b = 1;
  for (int i = 0; i <= columns; ++i) {
    for (int j = 0; j <= rows; ++j) mesh.vertices.push_back({a * i / columns, b * j / rows, 5.0});
  }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i * (rows + 1) + j); };
  for (int i = 0; i < columns; ++i) {
    for (int j = 0; j < rows; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  std::vector<double> exact;
  for (int m = 0; m < 9; ++m) {
    for (int n = 0; n < 5; ++n)
      exact.push_back(a * b * std::numbers::pi * std::numbers::pi * (m * m / (a * a) + n * n / (b * b)));
  }
  std::sort(exact.begin(), exact.end());
  const std::vector<double> found = laplacian_spectrum(mesh, 12).eigenvalues;
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i] / exact[i + 1], 1, 0.01) << i;
}

TEST(LaplacianSpectrum, KnowsNoPlaceScaleOrOrder) {
  const TriangleMesh torus = testing::torus(1, 0.4);
  const std::vector<double> before = laplacian_spectrum(torus, 20).eigenvalues;
  TriangleMesh other = torus;
  const auto n = static_cast<std::uint32_t>(torus.vertices.size());
  for (std::uint32_t i = 0; i < n; ++i) {
    const Vec3d& p = torus.vertices[i];
    other.vertices[n - 1 - i] = Vec3d{100, -3, 2} + 1e-3 * Vec3d{p.z, p.x, p.y};
  }
  for (Triangle& t : other.triangles) t = {n - 1 - t[2], n - 1 - t[0], n - 1 - t[1]};
  const std::vector<double> after = laplacian_spectrum(testing::reversed(other), 20).eigenvalues;
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(after[i] / before[i], 1, 1e-7) << i;
}

TEST(LaplacianSpectrum, EveryComponentAddsAZero) {
  const std::vector<double> pair = laplacian_spectrum(testing::two_spheres(3, 1.0, 5.0), 7).eigenvalues;
  EXPECT_NEAR(pair[0], 0, 1e-8);
  for (std::size_t i = 1; i < 7; ++i) EXPECT_NEAR(pair[i] / (16 * std::numbers::pi), 1, 0.02) << i;
}

TEST(LaplacianSpectrum, OfPointsIsThatOfTheirSurface) {
  const SurfaceSamples s = sample_poisson_disk(testing::icosphere(5, 0.1), 2000, 1);
  const LaplacianSpectrum spectrum = laplacian_spectrum(s.points, s.normals, 24);
  EXPECT_NEAR(spectrum.area / (0.04 * std::numbers::pi), 1, 0.02);
  expect_sphere(spectrum.eigenvalues, 0.03);
  const SurfaceSamples t = sample_poisson_disk(testing::torus(1, 0.4, 96, 48), 2000, 1);
  const std::vector<double> point_values = laplacian_spectrum(t.points, t.normals, 20).eigenvalues;
  const std::vector<double> mesh_values = laplacian_spectrum(testing::torus(1, 0.4, 96, 48), 20).eigenvalues;
  for (std::size_t i = 0; i < 20; ++i) EXPECT_NEAR(point_values[i] / mesh_values[i], 1, 0.03) << i;
}

TEST(LaplacianSpectrum, SameBitsForAnyThreadCount) {
  const SurfaceSamples s = sample_poisson_disk(testing::torus(1, 0.4), 500, 1);
  const std::vector<double> all = laplacian_spectrum(s.points, s.normals, 20).eigenvalues;
  const ThreadLimit one(1);
  EXPECT_EQ(laplacian_spectrum(s.points, s.normals, 20).eigenvalues, all);
}

TEST(LaplacianSpectrum, PassesOverVerticesAndTrianglesWithoutArea) {
  TriangleMesh mesh = testing::icosphere(2);
  const std::vector<double> clean = laplacian_spectrum(mesh, 8).eigenvalues;
  mesh.vertices.push_back({9, 9, 9});
  const auto a = mesh.triangles[0][0], b = mesh.triangles[0][1];
  mesh.triangles.push_back({a, a, b});
  const LaplacianSpectrum spectrum = laplacian_spectrum(mesh, 8);
  EXPECT_EQ(spectrum.left_out_triangles, 1);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(spectrum.eigenvalues[i] / clean[i], 1, 1e-9);
}

std::string refusal(const TriangleMesh& mesh, int count) {
  return testing::refusal_text([&] { laplacian_spectrum(mesh, count); });
}

TEST(LaplacianSpectrum, RefusesByName) {
  TriangleMesh fin = testing::icosphere(1);
  fin.vertices.push_back({3, 3, 3});
  fin.triangles.push_back(
      {fin.triangles[0][0], fin.triangles[0][1], static_cast<std::uint32_t>(fin.vertices.size() - 1)});
  EXPECT_NE(refusal(fin, 5).find("1 edges join three or more"), std::string::npos) << refusal(fin, 5);
  EXPECT_NE(refusal(testing::tetrahedron(), 5).find("5 eigenvalues of 4 vertices"), std::string::npos);
  EXPECT_NE(refusal(testing::icosphere(1), 0).find("0 eigenvalues"), std::string::npos);
  EXPECT_NE(refusal({}, 5), "no error");
  EXPECT_NE(refusal(TriangleMesh{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}, {}}, 1).find("no area"),
            std::string::npos);
  const std::vector<Vec3d> few(10, Vec3d{1, 0, 0});
  EXPECT_THROW(laplacian_spectrum(few, few, 3), InputError);
  const std::vector<Vec3d> one_place(40, Vec3d{1, 0, 0});
  EXPECT_THROW(laplacian_spectrum(one_place, one_place, 3), InputError);
}

std::vector<Vec3d> plane_points(int n) {
  CounterRandom random(5);
  std::vector<Vec3d> points;
  for (int i = 0; i < n; ++i) points.push_back({random.uniform(), random.uniform(), 0.25});
  return points;
}

// No circumscribed circle of a Delaunay triangle holds another point.
TEST(PointCloudTriangles, AreDelaunayInAPlane) {
  const std::vector<Vec3d> points = plane_points(60);
  const std::vector<Vec3d> normals(points.size(), Vec3d{0, 0, 1});
  // Every other point is a neighbour, so that the stars are those of the whole triangulation.
  const std::vector<Triangle> triangles = point_cloud_triangles(points, normals, 59);
  std::map<std::set<std::uint32_t>, int> found;
  for (const auto& [a, b, c] : triangles) {
    ++found[{a, b, c}];
    const Vec3d u = points[b] - points[a], v = points[c] - points[a];
    const double d = 2 * (u.x * v.y - u.y * v.x);
    const Vec3d center = points[a] + Vec3d{(v.y * squared_norm(u) - u.y * squared_norm(v)) / d,
                                           (u.x * squared_norm(v) - v.x * squared_norm(u)) / d, 0};
    for (const Vec3d& p : points) {
      EXPECT_GE(norm(p - center), norm(points[a] - center) * (1 - 1e-9));
    }
  }
  for (const auto& [corners, times] : found) EXPECT_EQ(times, 3);  // once from each of its corners
}

TEST(PointCloudTriangles, OfASphereTurnWithTheNormal) {
  const TriangleMesh sphere = testing::icosphere(3);
  const std::vector<Triangle> triangles = point_cloud_triangles(sphere.vertices, sphere.vertices, 12);
  EXPECT_NEAR(static_cast<double>(triangles.size()), 3.0 * static_cast<double>(sphere.triangles.size()),
              0.02 * static_cast<double>(triangles.size()));
  for (const auto& [a, b, c] : triangles) {
    const Vec3d& p = sphere.vertices[a];
    EXPECT_GT(dot(cross(sphere.vertices[b] - p, sphere.vertices[c] - p), p), 0);
  }
}

TEST(PointCloudTriangles, WantsANormalForEachPoint) {
  const std::vector<Vec3d> points = plane_points(10);
  EXPECT_THROW(point_cloud_triangles(points, {}, 5), InputError);
  EXPECT_THROW(point_cloud_triangles(points, points, 2), InputError);
  EXPECT_THROW(point_cloud_triangles(points, points, 10), InputError);
}

}  // namespace
}  // namespace astrolith
