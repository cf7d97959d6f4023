#include "estimation/shape/fit/containment.h"

#include <gtest/gtest.h>

#include "estimation/shape/fit/component_repair.h"
#include "tests/support/meshes.h"

namespace astrolith {
namespace {

TargetBody pancake(double thickness) {
  TriangleMesh mesh = testing::icosphere(5);
  for (Vec3d& p : mesh.vertices) p.z *= thickness;
  return prepare_target(mesh, "pancake");
}

// The number of points in each of 3 x 3 squares over the middle of the body.
std::vector<int> counts_over(const std::vector<Vec3d>& points, double half) {
  std::vector<int> counts(9, 0);
  for (const Vec3d& p : points) {
    const double x = 1.5 * (p.x / half + 1.0), y = 1.5 * (p.y / half + 1.0);
    if (x >= 0.0 && x < 3.0 && y >= 0.0 && y < 3.0) ++counts[static_cast<std::size_t>(3 * int(y) + int(x))];
  }
  return counts;
}

// A body thinner than the containment depth had no point inside, on its shells neither.
TEST(Containment, ThinBodiesHavePointsInside) {
  for (const double thickness : {0.02, 0.01}) {
    const TargetBody target = pancake(thickness);
    const FitPoints points = containment_points(target, {0.35 * thickness, 4000, 1, 2});
    EXPECT_GT(points.inside.size(), 500u) << thickness;
    for (const Vec3d& p : points.inside) EXPECT_GT(target.tree.signed_distance(p), 0.0);
    for (const int count : counts_over(points.inside, 0.2)) EXPECT_GT(count, 10) << thickness;
  }
}

// Thick bodies have the same points as before.
TEST(Containment, ThickBodiesHaveNoPointsInTheirMiddle) {
  for (const TriangleMesh& mesh : {testing::icosphere(4), testing::torus(1.0, 0.3)}) {
    const TargetBody target = prepare_target(mesh, "thick");
    FitPoints points;
    add_middle_points(target, 0.008, 1000, 1, points);
    EXPECT_TRUE(points.inside.empty());
    for (const Vec3d& p : containment_points(target, {0.1, 1000, 1, 2}).inside) {
      EXPECT_GT(target.tree.signed_distance(p), 0.7 * 0.008);
    }
  }
}

TEST(Containment, TheInsideOfAThinBodyIsWatched) {
  const TargetBody target = pancake(0.02);
  InsideWatch watch(target);
  MetaballModel nowhere;
  nowhere.spheres.emplace_back(Vec3d{5.0, 0.0, 0.0}, 0.1);
  std::vector<Vec3d> inside;
  watch.add_dips(nowhere, inside);
  EXPECT_GT(inside.size(), 100u);
}

}  // namespace
}  // namespace astrolith
