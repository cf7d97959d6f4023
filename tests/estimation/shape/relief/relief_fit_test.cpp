#include "estimation/shape/relief/relief_fit.h"

#include "geometry/mesh_topology.h"
#include "geometry/surface/surface_tree.h"
#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "synthesis/field/field_mesh.h"
#include "tests/support/meshes.h"
#include "tests/synthesis/bodies.h"

namespace astrolith {
namespace {

using testing::fractal_layer;
using testing::potato_recipe;

// A potato with bumps, and the potato alone.
struct Bumpy {
  Recipe base = potato_recipe(40, 9);
  TriangleMesh surface;

  explicit Bumpy(double amplitude = 0.02, int cells = 60) {
    Recipe bumpy = base;
    bumpy.layers = {fractal_layer(amplitude, 4.0, 2)};
    surface = make_coarse_mesh(ImplicitField(bumpy), cells);
  }
};

double mean_distance(const TriangleMesh& from, const Recipe& to) {
  const TriangleMesh mesh = make_coarse_mesh(ImplicitField(to), 120);
  const SurfaceTree tree(mesh);
  double sum = 0.0;
  for (const Vec3d& p : from.vertices) sum += std::fabs(tree.signed_distance(p));
  return sum / static_cast<double>(from.vertices.size());
}

TEST(ReliefFit, BringsTheBumpsBack) {
  const Bumpy bumpy;
  const ReliefFit relief = fit_relief(bumpy.surface, bumpy.base);
  EXPECT_LT(relief.residual, 0.1 * relief.base_distance);
  EXPECT_LT(relief.left_out, 0.01);
  Recipe whole = bumpy.base;
  whole.layers = {relief.layer};
  EXPECT_LT(mean_distance(bumpy.surface, whole), 0.15 * mean_distance(bumpy.surface, bumpy.base));
}

// Two lobes in contact, with a narrow neck between them.
Recipe lobes_in_contact() {
  Recipe recipe;
  recipe.body = MetaballBody{};
  recipe.body->blend_exponent = 4.0;
  recipe.body->spheres = {{{-0.5, 0, 0}, 0.45}, {{0.4, 0, 0}, 0.38}};
  recipe.body->subtract = {{{-0.1, 0.3, 0}, 0.2}, {{-0.1, -0.1, 0.3}, 0.2}};
  return recipe;
}

// Where few samples see a place, heights would be several times what was measured.
TEST(ReliefFit, HasNoHeightFarBeyondWhatWasMeasured) {
  Recipe bumpy = lobes_in_contact();
  const TriangleMesh bare = make_coarse_mesh(ImplicitField(bumpy), 60);
  bumpy.layers = {fractal_layer(0.02, 4.0, 2)};
  const ReliefFit relief = fit_relief(make_coarse_mesh(ImplicitField(bumpy), 60), lobes_in_contact());
  EXPECT_GT(relief.layer.low, -0.06);
  EXPECT_LT(relief.layer.high, 0.06);
  bumpy.layers = {relief.layer};
  const MeshTopology wanted = analyze_topology(bare),
                     made = analyze_topology(make_coarse_mesh(ImplicitField(bumpy), 120));
  EXPECT_EQ(made.components, wanted.components);
  EXPECT_EQ(made.genus, wanted.genus);
}

// Rounding moves heights by at most half a step.
TEST(ReliefFit, KeepsTheStepThatIsAskedFor) {
  const Bumpy bumpy;
  const ReliefFit fine = fit_relief(bumpy.surface, bumpy.base, {.spacing = 0.02, .step = 1e-4});
  const ReliefFit coarse = fit_relief(bumpy.surface, bumpy.base, {.spacing = 0.02, .step = 4e-3});
  EXPECT_NEAR(fine.layer.step(), 1e-4, 1e-12);
  EXPECT_NEAR(coarse.layer.step(), 4e-3, 1e-12);
  EXPECT_EQ(fine.heights, coarse.heights);
  EXPECT_LT(coarse.residual, fine.residual + 2e-3);
  EXPECT_GT(coarse.residual, fine.residual);
}

TEST(ReliefFit, IsTheSameForAnyThreadCount) {
  const Bumpy bumpy;
  std::vector<std::uint16_t> values[2];
  for (const int threads : {1, 3}) {
    const ThreadLimit limit(threads);
    values[threads / 3] = fit_relief(bumpy.surface, bumpy.base).layer.pixels->values;
  }
  EXPECT_EQ(values[0], values[1]);
}

TEST(ReliefFit, RefusesWhatHasNoRelief) {
  const Bumpy bumpy;
  EXPECT_THROW(fit_relief(testing::icosphere(2), bumpy.base), InputError);  // 320 facets
  EXPECT_THROW(fit_relief(bumpy.surface, bumpy.base, {.spacing = 1e-9}), InputError);
  TriangleMesh far = bumpy.surface;
  for (Vec3d& p : far.vertices) p.x += 50.0;
  EXPECT_THROW(fit_relief(far, bumpy.base), InputError);
}

}  // namespace
}  // namespace astrolith
