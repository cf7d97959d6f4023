#include "geometry/surface/decimated_mesh.h"

#include <gtest/gtest.h>

#include "tests/support/meshes.h"

namespace astrolith {
namespace {

TEST(DecimatedMesh, KeepsTheSphereWithATenthOfItsVertices) {
  const TriangleMesh sphere = testing::icosphere(5);
  const TriangleMesh fewer = decimated(sphere, 1000);
  EXPECT_LE(fewer.vertices.size(), 1000u);
  EXPECT_EQ(fewer.triangles.size(), 2 * fewer.vertices.size() - 4) << "still a closed sphere";
  for (const Vec3d& p : fewer.vertices) EXPECT_NEAR(norm(p), 1.0, 5e-3);
}

TEST(DecimatedMesh, LeavesASmallMeshAlone) {
  const TriangleMesh sphere = testing::icosphere(2);
  EXPECT_EQ(decimated(sphere, 1000).triangles.size(), sphere.triangles.size());
}

}  // namespace
}  // namespace astrolith
