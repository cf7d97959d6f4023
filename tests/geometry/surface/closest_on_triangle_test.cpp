#include "geometry/surface/closest_on_triangle.h"

#include <algorithm>

#include "numerics/hash_random.h"

namespace astrolith {
namespace {

TEST(ClosestOnTriangle, EachFeature) {
  using F = TriangleFeature;
  const Vec3d a{0, 0, 0}, b{4, 0, 0}, c{0, 3, 0};
  EXPECT_EQ(closest_on_triangle({1, 1, 5}, a, b, c).feature, F::face);
  EXPECT_DOUBLE_EQ(closest_on_triangle({1, 1, 5}, a, b, c).squared_distance, 25);
  EXPECT_EQ(closest_on_triangle({-1, -1, 2}, a, b, c).feature, F::corner_a);
  EXPECT_EQ(closest_on_triangle({9, -1, 2}, a, b, c).feature, F::corner_b);
  EXPECT_EQ(closest_on_triangle({-1, 9, 2}, a, b, c).feature, F::corner_c);
  EXPECT_EQ(closest_on_triangle({1, -2, 0}, a, b, c).feature, F::side_ab);
  EXPECT_EQ(closest_on_triangle({3, 4, 1}, a, b, c).feature, F::side_bc);
  EXPECT_EQ(closest_on_triangle({-1, 1, 0}, a, b, c).feature, F::side_ca);
}

// At an obtuse corner, a test by the two sides of the corner alone goes wrong.
TEST(ClosestOnTriangle, BeatsADenseSearch) {
  CounterRandom random(1);
  const auto vector = [&] { return Vec3d{random.normal(), random.normal(), random.normal()}; };
  for (int trial = 0; trial < 200; ++trial) {
    const Vec3d p = 3.0 * vector(), u = vector(), v = vector(), w = u + 0.1 * vector();
    const auto found = closest_on_triangle(p, u, v, w);
    double best = 1e300;
    for (int i = 0; i <= 60; ++i) {
      for (int j = 0; j <= 60 - i; ++j) {
        best = std::min(best, squared_norm(p - (u + (i / 60.0) * (v - u) + (j / 60.0) * (w - u))));
      }
    }
    const double longest = std::max(norm(v - u), norm(v - w));
    ASSERT_LE(found.squared_distance, best * (1 + 1e-12));
    ASSERT_GE(std::sqrt(found.squared_distance), std::sqrt(best) - longest / 60);
  }
}

TEST(ClosestOnTriangle, SegmentsAndPoints) {
  const Vec3d a{0, 0, 0}, b{4, 0, 0};
  EXPECT_DOUBLE_EQ(closest_on_triangle({1, 2, 0}, a, b, {2, 0, 0}).squared_distance, 4);
  EXPECT_DOUBLE_EQ(closest_on_triangle({5, 0, 0}, a, {2, 0, 0}, b).squared_distance, 1);
  EXPECT_DOUBLE_EQ(closest_on_triangle({1, 2, 2}, a, a, a).squared_distance, 9);
}

}  // namespace
}  // namespace astrolith
