#include "estimation/shape/target/surface_components.h"

#include "tests/support/meshes.h"

namespace astrolith {
namespace {

using testing::icosphere;
using testing::joined;
using testing::reversed;

TriangleMesh in_frame_of(const TargetBody& target, TriangleMesh mesh) {
  for (Vec3d& p : mesh.vertices) p = (p - target.center) * (1.0 / target.diagonal);
  return mesh;
}

TEST(SurfaceComponents, NoneIsWrongWhereTheyAgree) {
  const TargetBody target = prepare_target(testing::two_spheres(3, 1.0, 2.6), "pair");
  const ComponentComparison comparison = compare_components(target, target.mesh);
  EXPECT_EQ(comparison.wrong(), 0);
}

TEST(SurfaceComponents, IslandsAndCavitiesAreStrays) {
  const TargetBody target = prepare_target(icosphere(3), "sphere");
  const TriangleMesh fit =
      joined(joined(reversed(icosphere(2, 0.2, {0.3, 0, 0})), icosphere(3)), icosphere(2, 0.1, {0, 1.5, 0}));
  const ComponentComparison comparison = compare_components(target, in_frame_of(target, fit));
  EXPECT_EQ(comparison.missing, 0);
  ASSERT_EQ(comparison.strays.size(), 2u);
  EXPECT_TRUE(comparison.strays[0].cavity);
  EXPECT_NEAR(norm(comparison.strays[0].center - (Vec3d{0.3, 0, 0} - target.center) * (1 / target.diagonal)),
              0.0, 1e-9);
  EXPECT_NEAR(comparison.strays[0].radius, 0.2 / target.diagonal, 1e-3);
  EXPECT_FALSE(comparison.strays[1].cavity);
}

TEST(SurfaceComponents, LostAndJoinedComponentsAreMissing) {
  const TargetBody target = prepare_target(testing::two_spheres(3, 1.0, 2.6), "pair");
  EXPECT_EQ(compare_components(target, in_frame_of(target, icosphere(3, 1.0, {-1.3, 0, 0}))).missing, 1);
  TriangleMesh bar = icosphere(3);
  for (Vec3d& p : bar.vertices) p.x *= 2.3;
  EXPECT_EQ(compare_components(target, in_frame_of(target, bar)).missing, 1);
}

TEST(SurfaceComponents, ACavityOfTheTargetIsWanted) {
  const TriangleMesh hollow = joined(icosphere(3), reversed(icosphere(3, 0.5)));
  const TargetBody target = prepare_target(hollow, "hollow");
  EXPECT_EQ(compare_components(target, target.mesh).wrong(), 0);
  const ComponentComparison solid = compare_components(target, in_frame_of(target, icosphere(3)));
  EXPECT_EQ(solid.missing, 1);
  EXPECT_TRUE(solid.strays.empty());
}

}  // namespace
}  // namespace astrolith
