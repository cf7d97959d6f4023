#include <cmath>

#include "estimation/shape/fit/shape_fit.h"
#include "estimation/shape/fit/sphere_growth.h"
#include "estimation/shape/model/metaball_model.h"
#include "geometry/mesh_measure.h"
#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/field/implicit_field.h"
#include "tests/support/meshes.h"
#include "tests/support/refusal.h"

namespace astrolith {
namespace {

TriangleMesh make_mesh(const MetaballBody& body, int resolution) {
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
  const TargetBody target = prepare_target(make_mesh(truth, 64), "three");
  const ShapeFitResult fit = fit_shape(target, quick(16));
  EXPECT_LT(fit.check.distance.mean, 5e-4);
  EXPECT_LT(fit.check.distance.p99, 3e-3);
  EXPECT_NEAR(fit.check.volume_ratio, 1.0, 2e-3);
  EXPECT_TRUE(fit.check.topology.closed && fit.check.topology.manifold);
  EXPECT_EQ(fit.check.topology.components, 1);
  const MeasuredSimilarity measured = measure_similarity(target.surface, fit.check.mesh, 1);
  EXPECT_GT(measured.value, 0.95 * measured.floor);
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
      testing::has(testing::refusal_text([&] { fit_shape(target, quick(0)); }), "spheres: give 1 to 10000"));
}

TEST(SphereGrowth, NewSpheresStandWhereTheBumpIs) {
  // A unit sphere with a bump at +x, modelled by a unit sphere.
  TriangleMesh mesh = testing::icosphere(4);
  for (Vec3d& p : mesh.vertices) {
    if (p.x > 0.9) p = p * 1.15;
  }
  const MetaballModel model{3.0, {{{0, 0, 0}, 1.0}}};
  const SurfaceSamples samples = sample_surface(mesh, 2000, 1, SampleNormals::interpolated);
  const std::vector<ModelSphere> grown =
      spheres_for_largest_errors(model, samples, {surface_area(mesh), 20, 1, 1});
  ASSERT_EQ(grown.size(), 1u);
  EXPECT_GT(normalized(grown[0].center).x, 0.9);
  EXPECT_LT(norm(grown[0].center), 1.0);
  EXPECT_FALSE(grown[0].subtractive);
}

TEST(SphereGrowth, WhereTheModelSticksOutNewSpheresAreSubtractive) {
  TriangleMesh mesh = testing::icosphere(4);
  for (Vec3d& p : mesh.vertices) {
    if (p.x > 0.9) p = p * 0.85;
  }
  MetaballModel model{3.0, {{{0, 0, 0}, 1.0}}};
  const SurfaceSamples samples = sample_surface(mesh, 2000, 1, SampleNormals::interpolated);
  const auto grown = [&](int subtractive) {
    return spheres_for_largest_errors(model, samples, {surface_area(mesh), 20, 1, subtractive}).at(0);
  };
  const ModelSphere dent = grown(1);
  EXPECT_TRUE(dent.subtractive);
  EXPECT_GT(normalized(dent.center).x, 0.9);
  EXPECT_GT(norm(dent.center), 0.85);
  EXPECT_FALSE(grown(0).subtractive);
  const std::vector<Vec3d> dented{{0.85, 0, 0}};
  const double before = model_distances(model, dented)[0];
  model.spheres.push_back(dent);
  EXPECT_LT(model_distances(model, dented)[0], before);
}

TEST(SphereGrowth, BumpsAreAsWideAtEverySharpness) {
  const TriangleMesh mesh = testing::icosphere(3);
  const SurfaceSamples samples = sample_surface(mesh, 500, 1, SampleNormals::interpolated);
  const auto width = [&](double sharpness) {
    const MetaballModel model{sharpness, {{{0, 0, 0}, 1.1}}};
    const Sphere grown = spheres_for_largest_errors(model, samples, {surface_area(mesh), 20, 1}).at(0);
    return grown.radius / std::sqrt(sharpness);
  };
  EXPECT_NEAR(width(0.4), width(4.0), 1e-12);
}

TEST(SphereGrowth, IdleAndOutsideSpheresAreRemoved) {
  const TriangleMesh mesh = testing::icosphere(3);
  FitPoints points;
  points.on_surface = sample_surface(mesh, 500, 1).points;
  MetaballModel model{6.0, {{{0, 0, 0}, 1.0}, {{0.1, 0, 0}, 0.05}, {{3, 0, 0}, 0.2}}};
  EXPECT_EQ(remove_outside_spheres(model, SurfaceTree(mesh), 0.01), 1);
  EXPECT_EQ(remove_idle_spheres(model, points, 1e-3), 1);
  ASSERT_EQ(model.spheres.size(), 1u);
  EXPECT_EQ(model.spheres[0].radius, 1.0);
  EXPECT_EQ(remove_outside_spheres(model, SurfaceTree(testing::icosphere(3, 1.0, {9, 9, 9})), 0.01), 0)
      << "the last sphere stays";
}

TEST(SphereGrowth, TheLeastUsefulSphereGoesFirst) {
  const std::vector<Vec3d> points = sample_surface(testing::icosphere(3), 500, 1).points;
  // The second barely touches the surface, the third is a bump on it.
  MetaballModel model{6.0, {{{0, 0, 0}, 1.0}, {{0.3, 0, 0}, 0.4}, {{0, 0.9, 0}, 0.3}}};
  remove_least_useful_spheres(model, points, 1);
  ASSERT_EQ(model.spheres.size(), 2u);
  EXPECT_EQ(model.spheres[0].radius, 1.0);
  EXPECT_EQ(model.spheres[1].radius, 0.3);
}

TEST(SphereGrowth, OneAdditiveSphereStays) {
  FitPoints points;
  points.on_surface = sample_surface(testing::icosphere(3), 500, 1).points;
  MetaballModel model{6.0, {{{0, 0, 0}, 0.01}, {{1.2, 0, 0}, 0.4, true}}};
  remove_least_useful_spheres(model, points.on_surface, 1);
  EXPECT_EQ(model.spheres.size(), 2u) << "the additive one is the less useful";
  EXPECT_EQ(remove_idle_spheres(model, points, 0.02), 0);
}

TEST(IsosurfaceProjection, ArrivesOnASphereWithItsNormals) {
  const MetaballModel model{3.0, {{{0, 0, 0}, 1.0}}};
  const std::vector<Vec3d> points{{1.2, 0, 0}, {0, 0.7, 0}, {0.5, 0.5, 0.5}};
  const SurfaceSamples projected = project_onto_isosurface(model, points, 8);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(norm(projected.points[i]), 1.0, 1e-6);
    EXPECT_NEAR(norm(projected.normals[i] - normalized(points[i])), 0.0, 1e-6);
  }
}

}  // namespace
}  // namespace astrolith
