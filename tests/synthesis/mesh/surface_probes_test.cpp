#include "synthesis/mesh/surface_probes.h"

#include "synthesis/field/field_mesh.h"
#include "synthesis/field/implicit_field.h"
#include "tests/synthesis/bodies.h"

namespace astrolith {
namespace {

constexpr double kFar = 1e300;
const Box kEverywhere{{-kFar, -kFar, -kFar}, {kFar, kFar, kFar}};

// The side of a cube of edge 2 at z = 1, and a triangle far from it.
TriangleMesh square() {
  return {{{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}, {9, 0, 0}, {9, 1, 0}, {9, 0, 1}},
          {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}},
          {}};
}

TEST(ProbedSurface, AreaWithinABoxIsExact) {
  const ProbedSurface all(square(), kEverywhere), near(square(), {{-2, -2, -2}, {2, 2, 2}});
  EXPECT_DOUBLE_EQ(all.area(), 4.5);
  EXPECT_DOUBLE_EQ(near.area(), 4.0);
  EXPECT_NEAR(all.area_within({{-0.25, -0.5, 0}, {0.5, 3, 2}}), 0.75 * 1.5, 1e-12);
  EXPECT_NEAR(all.area_within({{-2, -2, 1.5}, {2, 2, 2}}), 0.0, 1e-12);
}

TEST(ProbedSurface, PointsLieEvenlyOverTheArea) {
  const ProbedSurface surface(square(), kEverywhere);
  int on_triangle = 0;
  Vec3d mean;
  for (int i = 0; i < 900; ++i) {
    const ProbedSurface::Point point = surface.point(i);
    if (point.position.x > 2.0) {
      ++on_triangle;
      continue;
    }
    EXPECT_DOUBLE_EQ(point.position.z, 1.0);
    EXPECT_DOUBLE_EQ(point.normal.z, 1.0);
    mean += (1.0 / 800.0) * point.position;
  }
  EXPECT_NEAR(on_triangle, 100, 3);
  EXPECT_NEAR(mean.x, 0.0, 0.05);
  EXPECT_NEAR(mean.y, 0.0, 0.05);
}

TEST(ProbedSurface, TheFullestSlabIsFound) {
  const ProbedSurface surface(square(), kEverywhere);
  EXPECT_NEAR(surface.largest_share(0.1), 4.0 / 4.5, 0.03);
  EXPECT_DOUBLE_EQ(surface.largest_share(5.0), 1.0);
}

struct Counts {
  double triangles, blocks;
};

// Predicted over true counts of a mesh of 256 cells, from a coarse mesh and `count` probes.
Counts predicted_over_true(const Recipe& recipe, int count) {
  constexpr int kCells = 256, kCoarse = 48;
  const ImplicitField field(recipe);
  MeshDiscard sink;
  const MeshStatistics made = mesh_field(field, field.bounds(), kCells, sink);
  const ProbedSurface surface(make_coarse_mesh(field, kCoarse), kEverywhere);
  const double reach = make_sample_grid(field.bounds(), kCoarse).step;
  const ProbeFigures figures = probe_surface<kBlockCells>(field, {surface, made.step, reach}, count);
  EXPECT_GT(figures.seconds, 0.0);
  EXPECT_GT(figures.evaluations, 0.0);
  return {figures.triangles * surface.area() / double(made.triangles),
          figures.blocks * surface.area() / double(made.active_blocks)};
}

TEST(SurfaceProbes, AFewPlacesTellTheTrianglesOfASmoothBody) {
  const Counts ratio = predicted_over_true(testing::potato_recipe(20, 3), 24);
  EXPECT_NEAR(ratio.triangles, 1.0, 0.06);
  EXPECT_NEAR(ratio.blocks, 1.0, 0.25);
}

// Details that the coarse mesh cannot show add triangles.
TEST(SurfaceProbes, FineDetailsAreSeenInTheColumns) {
  Recipe recipe = testing::potato_recipe(20, 3);
  recipe.layers.push_back(testing::fractal_layer(0.02, 8.0, 5));
  EXPECT_NEAR(predicted_over_true(recipe, 48).triangles, 1.0, 0.12);
}

}  // namespace
}  // namespace astrolith
