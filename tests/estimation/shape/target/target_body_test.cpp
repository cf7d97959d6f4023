#include <numbers>

#include "estimation/shape/target/surface_components.h"
#include "estimation/shape/target/target_body.h"
#include "numerics/errors.h"
#include "tests/support/meshes.h"
#include "tests/support/refusal.h"

namespace astrolith {
namespace {

using testing::icosphere;

std::string error_message(const TriangleMesh& mesh) {
  return testing::refusal_text([&] { prepare_target(mesh, "body.obj"); });
}

TEST(TargetBody, HasDiagonalOneAndKnowsTheWayBack) {
  const TargetBody target = prepare_target(icosphere(4, 3.0, {10, 20, 30}), "body.obj");
  EXPECT_NEAR(target.mesh.bounds().diagonal(), 1.0, 1e-12);
  const Vec3d p = target.center + target.diagonal * target.mesh.vertices[5];
  EXPECT_NEAR(norm(p - Vec3d{10, 20, 30}), 3.0, 1e-9);
  const double radius = 3.0 / target.diagonal;
  EXPECT_NEAR(target.area, 4 * std::numbers::pi * radius * radius, 0.01 * target.area);
  EXPECT_EQ(target.components, 1);
  EXPECT_TRUE(target.remarks.empty());
}

TEST(TargetBody, TurnsAnInsideOutMeshAndSaysSo) {
  const TargetBody target = prepare_target(testing::reversed(icosphere(2)), "body.obj");
  EXPECT_GT(target.volume, 0.0);
  EXPECT_EQ(target.remarks.size(), 1u);
  EXPECT_GT(target.tree.signed_distance({0, 0, 0}), 0.0);
}

TEST(TargetBody, WeldsRepeatedVertices) {
  const TriangleMesh sphere = icosphere(2);
  TriangleMesh soup;
  for (const Triangle& t : sphere.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t v : t) soup.vertices.push_back(sphere.vertices[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  const TargetBody target = prepare_target(soup, "body.obj");
  EXPECT_EQ(target.mesh.vertices.size(), sphere.vertices.size());
  EXPECT_EQ(target.remarks.size(), 1u);
}

TEST(TargetBody, RefusesWhatIsNoBody) {
  EXPECT_NE(error_message(testing::open_cap(2)).find("body.obj: mesh is open"), std::string::npos);
  EXPECT_NE(error_message({}).find("body.obj: no face"), std::string::npos);
  TriangleMesh flat = icosphere(2);
  for (Vec3d& p : flat.vertices) p.z *= 1e-9;
  EXPECT_NE(error_message(flat).find("no volume"), std::string::npos);
  TriangleMesh tiny = icosphere(2, 1e-12);
  EXPECT_NE(error_message(tiny).find("out of range"), std::string::npos);
}

TEST(TargetBody, RefusesASurfaceThroughItself) {
  // The upper half is pulled through itself and is then inside out.
  TriangleMesh bow_tie = icosphere(3);
  for (Vec3d& p : bow_tie.vertices) {
    const double width = p.z < 0.0 ? 1.0 : 1.0 - 2.3 * p.z;
    p = {p.x * width, p.y, p.z};
  }
  EXPECT_NE(error_message(bow_tie).find("body.obj: mesh passes through itself"), std::string::npos);
  const TriangleMesh one_reversed =
      testing::joined(icosphere(2, 2.0), testing::reversed(icosphere(2, 1.0, {5, 0, 0})));
  EXPECT_NE(error_message(one_reversed).find("has parts inside out"), std::string::npos);
}

TEST(TargetBody, AcceptsCavitiesAndSeveralComponents) {
  const TriangleMesh hollow = testing::joined(icosphere(3), testing::reversed(icosphere(3, 0.5)));
  EXPECT_EQ(error_message(hollow), "no error");
  EXPECT_EQ(error_message(testing::two_spheres(3, 1.0, 2.6)), "no error");
  EXPECT_EQ(error_message(testing::torus(1.0, 0.3)), "no error");
}

TEST(TargetBody, OverlappingComponentsBecomeTheirUnion) {
  const TargetBody apart = prepare_target(testing::two_spheres(3, 1.0, 2.6), "apart");
  EXPECT_EQ(apart.components, 2);
  ASSERT_EQ(apart.remarks.size(), 1u);
  EXPECT_NE(apart.remarks[0].find("holds 2 surfaces apart"), std::string::npos);
  EXPECT_EQ(apart.surface.triangles.size(), apart.mesh.triangles.size());
  // Two unit spheres one radius apart: each loses the cap of height 1/2, a quarter of its area.
  const TargetBody joined = prepare_target(testing::two_spheres(4, 1.0, 1.0), "joined");
  EXPECT_EQ(joined.components, 1);
  EXPECT_EQ(joined.remarks.size(), 1u);
  EXPECT_NEAR(joined.area * joined.diagonal * joined.diagonal, 2 * 0.75 * 4 * std::numbers::pi, 0.15);
}

TEST(TargetBody, ContainmentPointsAreAsDeepAsAsked) {
  const TargetBody target = prepare_target(testing::torus(1.0, 0.3), "torus.obj");
  FitPoints points;
  add_containment_points(target, 0.02, 200, 1, points);
  EXPECT_EQ(points.inside.size(), 200u);
  EXPECT_EQ(points.outside.size(), 200u);
  for (const Vec3d& p : points.inside) EXPECT_GT(target.tree.signed_distance(p), 0.02);
  for (const Vec3d& p : points.outside) EXPECT_LT(target.tree.signed_distance(p), -0.02);
}

using testing::joined;
using testing::reversed;

TriangleMesh to_target_frame(const TargetBody& target, TriangleMesh mesh) {
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
  const ComponentComparison comparison = compare_components(target, to_target_frame(target, fit));
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
  EXPECT_EQ(compare_components(target, to_target_frame(target, icosphere(3, 1.0, {-1.3, 0, 0}))).missing, 1);
  TriangleMesh bar = icosphere(3);
  for (Vec3d& p : bar.vertices) p.x *= 2.3;
  EXPECT_EQ(compare_components(target, to_target_frame(target, bar)).missing, 1);
}

TEST(SurfaceComponents, ACavityOfTheTargetIsWanted) {
  const TriangleMesh hollow = joined(icosphere(3), reversed(icosphere(3, 0.5)));
  const TargetBody target = prepare_target(hollow, "hollow");
  EXPECT_EQ(compare_components(target, target.mesh).wrong(), 0);
  const ComponentComparison solid = compare_components(target, to_target_frame(target, icosphere(3)));
  EXPECT_EQ(solid.missing, 1);
  EXPECT_TRUE(solid.strays.empty());
}

}  // namespace
}  // namespace astrolith
