#include "estimation/shape/packing/sphere_packing.h"

#include "geometry/mesh_measure.h"
#include "numerics/parallel_for.h"
#include "tests/support/meshes.h"

namespace astrolith {
namespace {

using testing::icosphere;

Packing pack(const TriangleMesh& mesh, int spheres) {
  PackingOptions options;
  options.max_spheres = spheres;
  return pack_spheres(mesh, SurfaceTree(mesh), options);
}

void expect_inside_and_apart(const Packing& packing, const TriangleMesh& mesh) {
  const SurfaceTree tree(mesh);
  const double slack = 1e-9 * mesh.bounds().diagonal();
  for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
    const Sphere& s = packing.spheres[i];
    EXPECT_GE(tree.signed_distance(s.center), s.radius - slack);
    for (std::size_t j = 0; j < i; ++j) {
      const Sphere& other = packing.spheres[j];
      EXPECT_GE(norm(s.center - other.center), s.radius + other.radius - slack);
      EXPECT_GE(other.radius, s.radius) << "largest first";
    }
  }
}

TEST(SpherePacking, BallIsFilledByOneSphereOfItsRadius) {
  const TriangleMesh mesh = icosphere(4, 2.0, {1, -1, 3});
  const Packing packing = pack(mesh, 1);
  ASSERT_EQ(packing.spheres.size(), 1u);
  EXPECT_NEAR(packing.spheres[0].radius, 2.0, 0.01);
  EXPECT_NEAR(norm(packing.spheres[0].center - Vec3d{1, -1, 3}), 0.0, 0.01);
  EXPECT_NEAR(packing.filling_rate, 1.0, 0.02);
}

TEST(SpherePacking, CubeIsFilledInsideWithoutOverlap) {
  const TriangleMesh mesh = testing::cube(1.0);
  const Packing packing = pack(mesh, 60);
  ASSERT_EQ(packing.spheres.size(), 60u);
  expect_inside_and_apart(packing, mesh);
  EXPECT_NEAR(packing.spheres[0].radius, 0.5, 1e-3);
  // The largest sphere in a cube's corner touches the inscribed one: r = (2 - sqrt 3) / 2 there.
  for (int i = 1; i <= 8; ++i) EXPECT_NEAR(packing.spheres[static_cast<std::size_t>(i)].radius, 0.1340, 4e-3);
  EXPECT_GT(packing.filling_rate, 0.60);
}

TEST(SpherePacking, BothPartsOfAPairGetTheirShare) {
  const TriangleMesh mesh = testing::joined(icosphere(3, 1.0, {0, 0, 0}), icosphere(3, 0.6, {4, 0, 0}));
  const Packing packing = pack(mesh, 2);
  ASSERT_EQ(packing.spheres.size(), 2u);
  EXPECT_NEAR(packing.spheres[0].radius, 1.0, 0.03);
  EXPECT_NEAR(packing.spheres[1].radius, 0.6, 0.02);
}

TEST(SpherePacking, SameBitsForOneAndTwoThreads) {
  const TriangleMesh mesh = testing::torus(1.0, 0.4);
  std::vector<Packing> packings;
  for (const int threads : {1, 2}) {
    const ThreadLimit limit(threads);
    packings.push_back(pack(mesh, 30));
  }
  expect_inside_and_apart(packings[0], mesh);
  ASSERT_EQ(packings[0].spheres.size(), packings[1].spheres.size());
  for (std::size_t i = 0; i < packings[0].spheres.size(); ++i) {
    EXPECT_EQ(packings[0].spheres[i].center, packings[1].spheres[i].center);
    EXPECT_EQ(packings[0].spheres[i].radius, packings[1].spheres[i].radius);
  }
}

}  // namespace
}  // namespace astrolith
