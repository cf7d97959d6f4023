#include "estimation/shape/fit/component_repair.h"
#include "estimation/shape/fit/fit_check.h"
#include "estimation/shape/model/metaball_model.h"
#include "geometry/surface/mesh_sampling.h"
#include "tests/support/meshes.h"

namespace astrolith {
namespace {

// Metaballs just under the surface of a ball with radius 0.3. The model has a cavity in the middle.
MetaballModel hollow_ball() {
  MetaballModel model{3.0, {}};
  for (const Vec3d& p : testing::icosphere(1, 0.22).vertices) model.spheres.push_back({p, 0.1});
  return model;
}

TargetBody ball() { return prepare_target(testing::icosphere(3, 0.5 / std::sqrt(3.0)), "ball"); }

ComponentComparison find_components(const TargetBody& target, const MetaballModel& model) {
  return compare_components(target, check_fit(target, metaball_body(model), 64, 1000, 1).mesh);
}

TEST(ComponentRepair, CavitiesAreFilledAndTheCountStays) {
  const TargetBody target = ball();
  MetaballModel model = hollow_ball();
  const ComponentComparison before = find_components(target, model);
  ASSERT_EQ(before.strays.size(), 1u);
  EXPECT_TRUE(before.strays[0].cavity);
  const std::size_t count = model.spheres.size();
  fill_cavities(model, before.strays, sample_surface(target.mesh, 500, 1).points);
  EXPECT_EQ(model.spheres.size(), count);
  EXPECT_TRUE(find_components(target, model).strays.empty());
}

TEST(ComponentRepair, SubtractiveMetaballsThatMakeACavityAreRemoved) {
  const TargetBody target = ball();
  MetaballModel model{3.0, {{{0, 0, 0}, 0.29}, {{0.1, 0, 0}, 0.1, true}}};
  model.spheres.emplace_back(Vec3d{-0.1, 0, 0}, 0.1);
  model.spheres[1].radius = 0.15;
  const ComponentComparison before = find_components(target, model);
  ASSERT_EQ(before.strays.size(), 1u);
  EXPECT_TRUE(before.strays[0].cavity);
  fill_cavities(model, before.strays, sample_surface(target.mesh, 500, 1).points);
  EXPECT_TRUE(std::none_of(model.spheres.begin(), model.spheres.end(),
                           [](const ModelSphere& s) { return s.subtractive; }));
  EXPECT_TRUE(find_components(target, model).strays.empty());
}

TEST(ComponentRepair, IslandsAreRemoved) {
  const TargetBody target = ball();
  MetaballModel model{3.0, {{{0, 0, 0}, 0.28}, {{0.6, 0, 0}, 0.05}}};
  const ComponentComparison before = find_components(target, model);
  ASSERT_EQ(before.strays.size(), 1u);
  EXPECT_FALSE(before.strays[0].cavity);
  remove_islands(model, before.strays);
  ASSERT_EQ(model.spheres.size(), 1u);
  EXPECT_EQ(model.spheres[0].radius, 0.28);
}

TEST(ComponentRepair, TheWatchFindsDipsOnce) {
  InsideWatch watch(ball());
  std::vector<Vec3d> dips;
  watch.add_dips({3.0, {{{0, 0, 0}, 0.29}}}, dips);
  EXPECT_TRUE(dips.empty());
  watch.add_dips(hollow_ball(), dips);
  const std::size_t count = dips.size();
  EXPECT_GT(count, 100u);
  for (const double level : model_levels(hollow_ball(), dips)) EXPECT_LT(level, 0.05);
  watch.add_dips(hollow_ball(), dips);
  EXPECT_EQ(dips.size(), count);
}

// A bridge lies near the target, where only its normals tell it from the target's surface.
TEST(SurfaceRepair, VerticesTurnedAwayAreStraysEarlier) {
  const TargetBody target = ball();
  const double radius = 0.5 / std::sqrt(3.0);
  const TriangleMesh near = testing::icosphere(2, 0.004, {radius + 0.005, 0.0, 0.0});
  EXPECT_TRUE(stray_points(target, near, 0.015, 0.015).outside.empty());
  const FitPoints strays = stray_points(target, near, 0.015, 0.002);
  EXPECT_TRUE(strays.inside.empty());
  ASSERT_FALSE(strays.outside.empty());
  for (const Vec3d& p : strays.outside) EXPECT_LT(p.x, radius + 0.005 + 0.004 * 0.6);
  EXPECT_LT(strays.outside.size(), near.vertices.size());
}

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
