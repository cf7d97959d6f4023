#include "descriptor/spectrum/point_cloud_triangles.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "tests/support/meshes.h"

namespace astrolith {
namespace {

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
