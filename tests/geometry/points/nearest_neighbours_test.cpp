#include "geometry/points/nearest_neighbours.h"

#include <algorithm>
#include <cmath>
#include <numeric>

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

}  // namespace
}  // namespace astrolith
