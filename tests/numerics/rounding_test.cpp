#include <vector>

#include "numerics/vec3.h"

namespace astrolith {
namespace {

// A double must be rounded to float whatever the optimiser makes of neighbouring statements. g++ 12.2 drops
// the rounding without -fno-tree-slp-vectorize.
__attribute__((noinline)) void round_to_float(std::vector<Vec3d>& points) {
  for (Vec3d& p : points) p = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

TEST(Rounding, OfNeighbouringComponentsIsKept) {
  std::vector<Vec3d> points(5, Vec3d{0.1, 0.2, 0.3});
  round_to_float(points);
  for (const Vec3d& p : points) {
    EXPECT_EQ(p.x, static_cast<double>(0.1f));
    EXPECT_EQ(p.y, static_cast<double>(0.2f));
    EXPECT_EQ(p.z, static_cast<double>(0.3f));
  }
}

}  // namespace
}  // namespace astrolith
