#include "geometry/orient_faces.h"

#include "geometry/mesh_measure.h"
#include "geometry/mesh_topology.h"
#include "numerics/hash_random.h"
#include "tests/support/meshes.h"

namespace astrolith {
namespace {

using namespace testing;

TEST(OrientFaces, RepairsRandomFlips) {
  for (const TriangleMesh& mesh : {icosphere(3, 2, {9, 9, 9}), torus(2, 0.5), two_spheres(2, 1, 5)}) {
    TriangleMesh flipped = mesh;
    CounterRandom random(3);
    for (Triangle& t : flipped.triangles) {
      if (random.uniform() < 0.4) std::swap(t[1], t[2]);
    }
    EXPECT_FALSE(analyze_topology(flipped).oriented);
    const TriangleMesh repaired = orient_faces(flipped);
    EXPECT_TRUE(analyze_topology(repaired).oriented);
    EXPECT_NEAR(volume(repaired), volume(mesh), 1e-9);
    EXPECT_NEAR(volume(orient_faces(reversed(mesh))), volume(mesh), 1e-9);
  }
}

TEST(OrientFaces, LeavesAGoodMeshAlone) {
  const TriangleMesh mesh = torus(3, 1);
  EXPECT_TRUE(orient_faces(mesh).triangles == mesh.triangles);
}

}  // namespace
}  // namespace astrolith
