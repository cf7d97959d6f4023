#include "estimation/shape/fit/component_repair.h"

#include "estimation/shape/fit/fit_check.h"
#include "estimation/shape/model/model_levels.h"
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

ComponentComparison components_of(const TargetBody& target, const MetaballModel& model) {
  return compare_components(target, check_fit(target, metaball_body(model), 64, 1000, 1).mesh);
}

TEST(ComponentRepair, CavitiesAreFilledAndTheCountStays) {
  const TargetBody target = ball();
  MetaballModel model = hollow_ball();
  const ComponentComparison before = components_of(target, model);
  ASSERT_EQ(before.strays.size(), 1u);
  EXPECT_TRUE(before.strays[0].cavity);
  const std::size_t count = model.spheres.size();
  fill_cavities(model, before.strays, sample_surface(target.mesh, 500, 1).points);
  EXPECT_EQ(model.spheres.size(), count);
  EXPECT_TRUE(components_of(target, model).strays.empty());
}

TEST(ComponentRepair, SubtractiveMetaballsThatMakeACavityAreRemoved) {
  const TargetBody target = ball();
  MetaballModel model{3.0, {{{0, 0, 0}, 0.29}, {{0.1, 0, 0}, 0.1, true}}};
  model.spheres.emplace_back(Vec3d{-0.1, 0, 0}, 0.1);
  model.spheres[1].radius = 0.15;
  const ComponentComparison before = components_of(target, model);
  ASSERT_EQ(before.strays.size(), 1u);
  EXPECT_TRUE(before.strays[0].cavity);
  fill_cavities(model, before.strays, sample_surface(target.mesh, 500, 1).points);
  EXPECT_TRUE(std::none_of(model.spheres.begin(), model.spheres.end(),
                           [](const ModelSphere& s) { return s.subtractive; }));
  EXPECT_TRUE(components_of(target, model).strays.empty());
}

TEST(ComponentRepair, IslandsAreRemoved) {
  const TargetBody target = ball();
  MetaballModel model{3.0, {{{0, 0, 0}, 0.28}, {{0.6, 0, 0}, 0.05}}};
  const ComponentComparison before = components_of(target, model);
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

}  // namespace
}  // namespace astrolith
