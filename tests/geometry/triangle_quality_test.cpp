#include "geometry/triangle_quality.h"

#include <gtest/gtest.h>

#include <vector>

namespace astrolith {
namespace {

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
  const QualityFigures figures = quality_of(vertices, triangles);
  EXPECT_NEAR(figures.first_percentile, 0.8660254, 1e-6);
  EXPECT_NEAR(figures.mean, 0.99 * 0.8660254, 1e-6);
  triangles.push_back({0, 1, 3});
  EXPECT_EQ(quality_of(vertices, triangles).first_percentile, 0.0);
  EXPECT_EQ(quality_of({}, {}).mean, 0.0);
}

}  // namespace
}  // namespace astrolith
