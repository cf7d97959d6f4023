#include "geometry/points/point_normals.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "geometry/points/nearest_neighbours.h"
#include "geometry/surface/mesh_sampling.h"
#include "numerics/errors.h"
#include "tests/support/meshes.h"

namespace astrolith {
namespace {

TEST(NearestNeighbours, AreThoseOfAllDistances) {
  const std::vector<Vec3d> points = sample_surface(testing::torus(1, 0.4), 300, 1).points;
  const std::vector<std::uint32_t> found = nearest_neighbours(points, 7);
  for (std::uint32_t i = 0; i < 300; ++i) {
    std::vector<std::uint32_t> order(300);
    std::iota(order.begin(), order.end(), 0u);
    std::erase(order, i);
    const auto distance = [&](std::uint32_t j) { return squared_norm(points[j] - points[i]); };
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return distance(a) < distance(b); });
    EXPECT_TRUE(std::equal(order.begin(), order.begin() + 7, found.begin() + 7 * i)) << i;
  }
}

TEST(NearestNeighbours, ManyPointsInOnePlace) {
  const std::vector<Vec3d> points(100, Vec3d{1, 2, 3});
  const std::vector<std::uint32_t> found = nearest_neighbours(points, 5);
  for (std::uint32_t i = 0; i < 100; ++i) EXPECT_EQ(std::count(&found[5 * i], &found[5 * i] + 5, i), 0);
}

TEST(NearestNeighbours, RefusesMoreThanThereAre) {
  const std::vector<Vec3d> points{{0, 0, 0}, {1, 0, 0}};
  EXPECT_EQ(nearest_neighbours(points, 1), (std::vector<std::uint32_t>{1, 0}));
  EXPECT_THROW(nearest_neighbours(points, 2), InputError);
  EXPECT_THROW(nearest_neighbours(points, 0), InputError);
  const std::vector<Vec3d> wrong{{0, 0, 0}, {std::nan(""), 0, 0}};
  EXPECT_THROW(nearest_neighbours(wrong, 1), InputError);
}

TEST(PointNormals, OfASphereAreItsRadii) {
  const Vec3d center{1e4, 0, -1e4};
  const SurfaceSamples s = sample_poisson_disk(testing::icosphere(5, 1.0, center), 2000, 1);
  const std::vector<Vec3d> normals = point_normals(s.points, s.normals, 8);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    EXPECT_NEAR(norm(normals[i]), 1, 1e-12);
    EXPECT_GT(dot(normals[i], normalized(s.points[i] - center)), std::cos(4 * std::numbers::pi / 180));
  }
}

TEST(PointNormals, FollowTheHint) {
  const std::vector<Vec3d> square{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  const std::vector<Vec3d> up(4, Vec3d{0.1, 0, 2}), down(4, Vec3d{0, 0, -1});
  for (const Vec3d& n : point_normals(square, up, 3)) EXPECT_NEAR(n.z, 1, 1e-12);
  for (const Vec3d& n : point_normals(square, down, 3)) EXPECT_NEAR(n.z, -1, 1e-12);
  const std::vector<Vec3d> one_place(5, Vec3d{1, 2, 3}), hints(5, Vec3d{0, 0, 1});
  for (const Vec3d& n : point_normals(one_place, hints, 3)) EXPECT_NEAR(norm(n), 1, 1e-12);
  EXPECT_THROW(point_normals(square, {}, 3), InputError);
  EXPECT_THROW(point_normals(square, up, 4), InputError);
}

}  // namespace
}  // namespace astrolith
