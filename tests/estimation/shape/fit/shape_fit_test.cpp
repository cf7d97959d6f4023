#include "estimation/shape/fit/shape_fit.h"

#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/field/implicit_field.h"
#include "tests/support/meshes.h"
#include "tests/support/refusal.h"

namespace astrolith {
namespace {

TriangleMesh mesh_of(const MetaballBody& body, int resolution) {
  Recipe recipe;
  recipe.body = body;
  const ImplicitField field(recipe);
  MeshCollector collector;
  mesh_field(field, field.bounds(), resolution, collector);
  return std::move(collector.mesh);
}

ShapeFitOptions quick(int spheres) {
  ShapeFitOptions options;
  options.spheres = spheres;
  options.points = 1500;
  options.population = 8;
  options.generations = 4;
  options.check_resolution = 64;
  options.check_samples = 5000;
  return options;
}

TEST(ShapeFit, OneSphereBecomesOneMetaballOfItsRadius) {
  const TargetBody target = prepare_target(testing::icosphere(4, 2.0, {5, 6, 7}), "sphere");
  const ShapeFitResult fit = fit_shape(target, quick(1));
  ASSERT_EQ(fit.body.spheres.size(), 1u);
  EXPECT_NEAR(fit.body.spheres[0].radius, 2.0, 0.01);
  EXPECT_NEAR(norm(fit.body.spheres[0].center - Vec3d{5, 6, 7}), 0.0, 0.01);
  EXPECT_NEAR(fit.check.volume_ratio, 1.0, 0.01);
  EXPECT_LT(fit.check.distance.mean, 2e-3);
}

TEST(ShapeFit, RecoversABodyOfThreeMetaballs) {
  MetaballBody truth;
  truth.blend_exponent = 2.5;
  truth.spheres = {{{-0.9, 0, 0}, 0.9}, {{0.5, 0.2, 0}, 1.0}, {{1.3, 0.5, 0.3}, 0.6}};
  const TargetBody target = prepare_target(mesh_of(truth, 64), "three");
  const ShapeFitResult fit = fit_shape(target, quick(16));
  EXPECT_LT(fit.check.distance.mean, 5e-4);
  EXPECT_LT(fit.check.distance.p99, 3e-3);
  EXPECT_NEAR(fit.check.volume_ratio, 1.0, 2e-3);
  EXPECT_TRUE(fit.check.topology.closed && fit.check.topology.manifold);
  EXPECT_EQ(fit.check.topology.components, 1);
  EXPECT_GT(fit.similarity, 0.95 * fit.similarity_floor);
}

// Bodies with several components, and a body with a hole.
struct ComponentsCase {
  const char* name;
  TriangleMesh (*mesh)();
  std::int64_t components, genus;
};

class ShapeFitComponents : public ::testing::TestWithParam<ComponentsCase> {};

TEST_P(ShapeFitComponents, AreThoseOfTheTarget) {
  const TargetBody target = prepare_target(GetParam().mesh(), GetParam().name);
  const ShapeFitResult fit = fit_shape(target, quick(16));
  EXPECT_EQ(fit.check.topology.components, GetParam().components);
  EXPECT_EQ(fit.check.topology.genus, GetParam().genus);
  EXPECT_LT(fit.check.distance.mean, 3e-3);
}

INSTANTIATE_TEST_SUITE_P(
    Components, ShapeFitComponents,
    ::testing::Values(ComponentsCase{"Apart", [] { return testing::two_spheres(3, 1.0, 2.6); }, 2, 0},
                      ComponentsCase{"NearlyTouching", [] { return testing::two_spheres(3, 1.0, 2.1); }, 2,
                                     0},
                      ComponentsCase{"Overlapping", [] { return testing::two_spheres(3, 1.0, 1.8); }, 1, 0},
                      ComponentsCase{"Ring", [] { return testing::torus(1.0, 0.45); }, 1, 1}),
    [](const ::testing::TestParamInfo<ComponentsCase>& body) { return std::string(body.param.name); });

// Dents eat bodies of few metaballs up.
TEST(ShapeFit, FewMetaballsAreAllAdditive) {
  const TargetBody target = prepare_target(testing::icosphere(3, 2.0), "sphere");
  const ShapeFitResult fit = fit_shape(target, quick(5));
  EXPECT_TRUE(fit.body.subtract.empty());
  EXPECT_LT(fit.check.distance.mean, 0.01);
}

TEST(ShapeFit, SameBodyForOneAndTwoThreads) {
  const TargetBody target = prepare_target(testing::torus(1.0, 0.45), "torus");
  std::vector<MetaballBody> bodies;
  for (const int threads : {1, 2}) {
    const ThreadLimit limit(threads);
    bodies.push_back(fit_shape(target, quick(12)).body);
  }
  EXPECT_EQ(bodies[0].blend_exponent, bodies[1].blend_exponent);
  ASSERT_EQ(bodies[0].spheres.size(), bodies[1].spheres.size());
  for (std::size_t i = 0; i < bodies[0].spheres.size(); ++i) {
    EXPECT_EQ(bodies[0].spheres[i].center, bodies[1].spheres[i].center);
    EXPECT_EQ(bodies[0].spheres[i].radius, bodies[1].spheres[i].radius);
  }
}

TEST(ShapeFit, StopsWhenAskedWithABodyAllTheSame) {
  const TargetBody target = prepare_target(testing::torus(1.0, 0.45), "torus");
  const ShapeFitResult fit = fit_shape(target, quick(12), [](const std::string& stage) -> Progress {
    if (stage != "refine") return {};
    return [](double, std::string_view) { return false; };
  });
  EXPECT_TRUE(fit.interrupted);
  EXPECT_FALSE(fit.body.spheres.empty());
}

TEST(ShapeFit, ToleranceEndsTheGrowth) {
  const TargetBody target = prepare_target(testing::icosphere(3), "sphere");
  ShapeFitOptions options = quick(40);
  options.tolerance = 0.01;
  EXPECT_LT(fit_shape(target, options).body.spheres.size(), 40u);
}

// One metaball more never changes the plan of a fit by more than a step.
TEST(ShapeFit, ThePlanIsASmoothFunctionOfTheNumberOfMetaballs) {
  for (int spheres = 1; spheres < 2000; ++spheres) {
    const AdaptiveFitOptions one = options_for(spheres), more = options_for(spheres + 1);
    EXPECT_LE(more.relocations, one.relocations);
    EXPECT_LE(one.relocations - more.relocations, 1) << spheres;
    EXPECT_GE(more.relocation_iterations, one.relocation_iterations);
    EXPECT_LE(more.relocation_iterations - one.relocation_iterations, 1) << spheres;
    EXPECT_LE(more.grown_iterations - one.grown_iterations, 1) << spheres;
    EXPECT_LE(more.last_iterations - one.last_iterations, 1) << spheres;
    EXPECT_LE(more.least_decrease - one.least_decrease, 1e-6) << spheres;
  }
  EXPECT_EQ(options_for(200).relocations, 40);
  EXPECT_EQ(options_for(1000).relocations, 13);
  EXPECT_EQ(options_for(1000).relocation_iterations, 40);
  EXPECT_DOUBLE_EQ(options_for(1000).least_decrease, 1e-4);
  EXPECT_DOUBLE_EQ(options_for(10000).least_decrease, 1e-3);
  EXPECT_EQ(options_for(10000).grown_iterations, 12);
}

TEST(ShapeFit, RefusesOptionsOutOfRange) {
  const TargetBody target = prepare_target(testing::icosphere(2), "sphere");
  EXPECT_TRUE(
      testing::has(testing::refusal_of([&] { fit_shape(target, quick(0)); }), "spheres: give 1 to 10000"));
}

}  // namespace
}  // namespace astrolith
