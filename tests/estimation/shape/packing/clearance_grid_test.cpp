#include "estimation/shape/packing/clearance_grid.h"

#include <algorithm>
#include <cmath>

#include "tests/support/meshes.h"

namespace astrolith {
namespace {

// Calls check(centre of the cell, its clearance).
template <typename Check>
void for_each_cell(const ClearanceGrid& grid, const Check& check) {
  for (std::size_t i = 0; i < grid.clearance.size(); ++i) check(grid.center(i), grid.clearance[i]);
}

TEST(ClearanceGrid, CubeIsMeasuredToATenthOfAStep) {
  const TriangleMesh mesh = testing::cube(1.0);
  const ClearanceGrid grid = make_clearance_grid(mesh, SurfaceTree(mesh), 30000);
  std::size_t inside = 0;
  for_each_cell(grid, [&](const Vec3d& p, float clearance) {
    const Vec3d q = p - mesh.bounds().center();
    const double depth = 0.5 - std::max({std::abs(q.x), std::abs(q.y), std::abs(q.z)});
    inside += clearance > 0.0f ? 1 : 0;
    EXPECT_GE(clearance, std::max(0.0, depth) - 1e-5);
    EXPECT_LE(clearance, std::max(0.0, depth + 0.1 * grid.step));
    if (depth <= 0.0) {
      EXPECT_LE(clearance, 0.0f);
    }
  });
  EXPECT_NEAR(static_cast<double>(inside), 30000.0, 1500.0);
}

TEST(ClearanceGrid, AgreesWithTheTreeOnACurvedBody) {
  const TriangleMesh mesh = testing::torus(1.0, 0.4);
  const SurfaceTree tree(mesh);
  const ClearanceGrid grid = make_clearance_grid(mesh, tree, 5000);
  for_each_cell(grid, [&](const Vec3d& p, float clearance) {
    const double exact = std::max(0.0, tree.signed_distance(p));
    EXPECT_GE(clearance, exact - 1e-5);
    EXPECT_LE(clearance, exact + 0.15 * grid.step);
  });
}

TEST(ClearanceGrid, APlateKeepsWithinTheLimitOfCells) {
  TriangleMesh plate = testing::cube(1.0);
  for (Vec3d& v : plate.vertices) v.z *= 1e-7;
  const ClearanceGrid grid = make_clearance_grid(plate, SurfaceTree(plate), 1e6, 1e5);
  EXPECT_LE(static_cast<double>(grid.clearance.size()), 1e5);
}

}  // namespace
}  // namespace astrolith
