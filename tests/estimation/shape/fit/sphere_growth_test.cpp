#include "estimation/shape/fit/sphere_growth.h"

#include <cmath>

#include "estimation/shape/model/isosurface_projection.h"
#include "estimation/shape/model/model_levels.h"
#include "geometry/mesh_measure.h"
#include "tests/support/meshes.h"

namespace astrolith {
namespace {

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
