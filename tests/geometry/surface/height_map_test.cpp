#include "geometry/surface/height_map.h"

#include <gtest/gtest.h>

#include <cmath>

#include "numerics/errors.h"
#include "tests/support/meshes.h"

namespace astrolith {
namespace {

// A grid of n x n quadrilaterals over [-1, 1]^2 with heights f, seen along `up`.
template <typename Height>
TriangleMesh terrain(int n, const Vec3d& right, const Vec3d& ahead, const Vec3d& center, const Height& f) {
  TriangleMesh mesh;
  const Vec3d up = cross(right, ahead);
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const double x = 2.0 * i / n - 1, y = 2.0 * j / n - 1;
      mesh.vertices.push_back(center + x * right + y * ahead + f(x, y) * up);
    }
  }
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const auto at = [&](int a, int b) { return static_cast<std::uint32_t>((j + b) * (n + 1) + i + a); };
      mesh.triangles.push_back({at(0, 0), at(1, 0), at(1, 1)});
      mesh.triangles.push_back({at(0, 0), at(1, 1), at(0, 1)});
    }
  }
  return mesh;
}

// The formula of the header gives back points of the surface.
TEST(HeightMap, PixelsLieOnTheSurface) {
  const Vec3d up = normalized(Vec3d{2, 1, 1}), right = normalized(cross(Vec3d{0, 0, 1}, up)),
              ahead = cross(up, right);
  const auto f = [](double x, double y) { return 0.1 * std::sin(3 * x) * std::cos(2 * y); };
  const Vec3d center{5, -7, 11};
  const HeightMap map = height_map(terrain(200, right, ahead, center, f), 1.6, 64, 1000.0);
  ASSERT_EQ(map.heights.size(), 64u * 64);
  EXPECT_LT(norm(map.up - up), 1e-2);
  EXPECT_NEAR(dot(cross(map.right, map.ahead), map.up), 1.0, 1e-12);
  for (int j = 0; j < 64; ++j) {
    for (int i = 0; i < 64; ++i) {
      const double height = map.heights[static_cast<std::size_t>(64 * j + i)] / 1000.0;
      ASSERT_TRUE(std::isfinite(height));
      const Vec3d p = map.origin + (i + 0.5 - 32) * map.pixel * map.right +
                      (32 - (j + 0.5)) * map.pixel * map.ahead + height * map.up - center;
      EXPECT_NEAR(dot(p, up), f(dot(p, right), dot(p, ahead)), 2e-4);
    }
  }
}

TEST(HeightMap, NoDataOutsideAndTheHighestOfSeveral) {
  const auto flat = [](double, double) { return 0.0; };
  const TriangleMesh low = terrain(4, {1, 0, 0}, {0, 1, 0}, {}, flat);
  const HeightMap wide = height_map(low, 4.0, 8, 1.0);
  EXPECT_TRUE(std::isnan(wide.heights.front()));
  EXPECT_EQ(wide.heights[8 * 4 + 4], 0.0f);
  TriangleMesh high = terrain(4, {0.25, 0, 0}, {0, 0.25, 0}, {}, flat);
  for (Vec3d& p : high.vertices) p.z = 0.5;
  const HeightMap both = height_map(testing::joined(low, high), 1.0, 8, 1.0);
  EXPECT_NEAR(both.heights[8 * 4 + 4] - both.heights[0], 0.5, 1e-6);
}

TEST(HeightMap, ABodyFacesNoDirection) {
  EXPECT_THROW(height_map(testing::reversed({}), 1, 8, 1), InputError);
}

}  // namespace
}  // namespace astrolith
