#include "geometry/surface/winding_number.h"

#include "tests/support/meshes.h"

namespace astrolith {
namespace {

TEST(WindingNumber, CountsHowOftenASurfaceGoesAround) {
  const TriangleMesh pair = testing::two_spheres(2, 1.0, 1.0);  // at x = -0.5 and 0.5
  EXPECT_NEAR(winding_number(pair, {0, 0, 0}), 2.0, 1e-9);
  EXPECT_NEAR(winding_number(pair, {1.2, 0, 0}), 1.0, 1e-9);
  EXPECT_NEAR(winding_number(pair, {3, 0, 0}), 0.0, 1e-9);
  EXPECT_NEAR(winding_number(testing::reversed(pair), {1.2, 0, 0}), -1.0, 1e-9);
}

}  // namespace
}  // namespace astrolith
