#include "synthesis/mesh/manifold_check.h"

#include <vector>

#include "numerics/errors.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

constexpr std::uint32_t kRing = 20000;  // vertices: more than one thread checks at a time

// Two cones on one ring of vertices. The apexes, vertices kRing and kRing + 1, have kRing triangles each.
std::vector<Triangle> double_cone() {
  std::vector<Triangle> triangles;
  for (std::uint32_t i = 0; i < kRing; ++i) {
    triangles.push_back({i, (i + 1) % kRing, kRing});
    triangles.push_back({(i + 1) % kRing, i, kRing + 1});
  }
  return triangles;
}

// Checks so many vertices and these triangles, given at once, on one thread and on four.
ManifoldReport checked(std::uint32_t vertices, const std::vector<Triangle>& triangles) {
  ManifoldReport reports[2];
  for (const int threads : {1, 4}) {
    const ThreadLimit limit(threads);
    ManifoldCheck check;
    check.add_batch(std::vector<MeshVertex>(vertices), triangles);
    reports[threads == 1 ? 0 : 1] = check.finish();
  }
  EXPECT_EQ(reports[0].open_vertices, reports[1].open_vertices);
  EXPECT_EQ(reports[0].non_manifold_vertices, reports[1].non_manifold_vertices);
  EXPECT_EQ(reports[0].components, reports[1].components);
  return reports[1];
}

TEST(ManifoldCheck, PassesVerticesOfManyTriangles) {
  const ManifoldReport report = checked(kRing + 2, double_cone());
  EXPECT_TRUE(report.closed() && report.manifold());
  EXPECT_EQ(report.genus, 0);
  EXPECT_EQ(report.components, 1);
}

TEST(ManifoldCheck, CountsTheVerticesOfAHole) {
  std::vector<Triangle> triangles = double_cone();
  triangles.erase(triangles.begin() + kRing);
  const ManifoldReport report = checked(kRing + 2, triangles);
  EXPECT_EQ(report.open_vertices, 3);
  EXPECT_TRUE(report.manifold() && !report.closed());
}

TEST(ManifoldCheck, CountsTheVerticesOfATriangleTooMany) {
  std::vector<Triangle> triangles = double_cone();
  triangles.push_back(triangles[kRing]);
  EXPECT_EQ(checked(kRing + 2, triangles).non_manifold_vertices, 3);
}

TEST(ManifoldCheck, CountsComponentsAndVerticesOfNoTriangle) {
  std::vector<Triangle> triangles = double_cone();
  for (const auto& [a, b, c] : double_cone())
    triangles.push_back({a + kRing + 2, b + kRing + 2, c + kRing + 2});
  EXPECT_EQ(checked(2 * kRing + 4, triangles).components, 2);
  const ManifoldReport report = checked(2 * kRing + 5, triangles);
  EXPECT_EQ(report.components, 3);
  EXPECT_EQ(report.non_manifold_vertices, 1);
}

TEST(ManifoldCheck, LeavesOutTrianglesOfVerticesThatLeftTheWindow) {
  const std::vector<MeshVertex> vertices(3);
  const std::vector<Triangle> triangle{{0, 1, 2}}, late{{0, 7, 8}};
  ManifoldCheck check;
  check.add_batch(vertices, triangle);
  check.add_batch(vertices, {});
  check.add_batch(vertices, late);
  EXPECT_THROW(check.add_triangles(std::vector<Triangle>{{0, 1, 9}}), WorkError);
  EXPECT_EQ(check.finish().late_triangles, 1);
}

}  // namespace
}  // namespace astrolith
