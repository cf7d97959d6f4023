#include "synthesis/field/patch_field.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "geometry/mesh_sink.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/mesh/manifold_check.h"
#include "tests/synthesis/bodies.h"

namespace astrolith {
namespace {

double farthest_coordinate(const Vec3d& p) { return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}); }

SpotLayer spots(double size) {
  SpotLayer layer;
  layer.amplitude = 0.1 * size;
  layer.size = size;
  layer.cell_size = 4.0 * size;
  return layer;
}

// A body about 1 long with every kind of layer and a warp.
Recipe layered_potato() {
  Recipe recipe = testing::potato_recipe(12, 5);
  recipe.layers = {testing::fractal_layer(0.02, 5.0, 6), spots(0.03), testing::gabor_layer(0.03, 0.003)};
  recipe.body->warp = Warp{0.02, 2.0, 2, 0.5, 1.95};
  return recipe;
}

// A sphere of 250 m with hills down to centimetres.
Recipe large_sphere(Noise noise, double modulation) {
  Recipe recipe = testing::sphere_recipe(250.0);
  recipe.length_unit = "m";
  FractalLayer hills = testing::fractal_layer(8.0, 0.02, 12);
  hills.noise = noise;
  hills.scale = {1.0, 1.25, 0.75};
  hills.bias = {3.7, -1e3, 0.1};
  hills.gradient_modulation = modulation;
  recipe.layers = {hills};
  return recipe;
}

// A point of the surface on the ray from the origin, by bisection in the field's own precision.
Vec3d on_surface(const ImplicitField& field, const Vec3d& direction, double inside, double outside) {
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (inside + outside);
    (field.inside(middle * direction) ? inside : outside) = middle;
  }
  return inside * direction;
}

float value_near(const ImplicitField& field, const Vec3d& origin, const Vec3d& local) {
  const float x = static_cast<float>(local.x), y = static_cast<float>(local.y),
              z = static_cast<float>(local.z);
  float value = 0.0f;
  field.gather(Box{origin, origin})
      .evaluate_local(origin, {&x, 1}, {&y, 1}, {&z, 1}, {&value, 1}, kExactEverywhere);
  return value;
}

TEST(PatchField, OnTheGridOfTheWholeMeshItHasItsVertices) {
  const ImplicitField field(layered_potato());
  constexpr int kResolution = 64;
  MeshCollector whole, patch;
  const double step = mesh_field(field, field.bounds(), kResolution, whole).step;
  const SampleGrid grid = make_sample_grid(field.bounds(), kResolution);
  const Vec3d start = whole.mesh.vertices[whole.mesh.vertices.size() / 3];
  const auto sample = [&](double p, double first) { return first + step * std::round((p - first) / step); };
  const Vec3d center{sample(start.x, grid.origin.x), sample(start.y, grid.origin.y),
                     sample(start.z, grid.origin.z)};
  constexpr int kCells = 24;
  const MeshStatistics statistics = mesh_patch(PatchField(field, center), kCells * step, kCells, patch);
  EXPECT_GT(statistics.cut_vertices, 0);
  std::vector<Vec3d> inside;
  for (const Vec3d& p : whole.mesh.vertices) {
    if (farthest_coordinate(p - center) <= (0.5 * kCells + 1e-4) * step) inside.push_back(p - center);
  }
  ASSERT_EQ(inside.size(), patch.mesh.vertices.size());
  double farthest = 0.0;
  for (std::size_t i = 0; i < inside.size(); ++i) {
    farthest = std::max(farthest, norm(inside[i] - patch.mesh.vertices[i]));
  }
  EXPECT_LT(farthest, 4e-6);  // the body is about 1 long
}

// Two origins give the same surface, although they share no float coordinates.
TEST(PatchField, ValuesDoNotDependOnTheOrigin) {
  for (const Noise noise : {Noise::kSimplex, Noise::kPerlin, Noise::kWorleyF1, Noise::kWorleyF2MinusF1}) {
    const ImplicitField field(large_sphere(noise, is_worley(noise) ? 0.0 : 0.3));
    const Vec3d center = on_surface(field, normalized(Vec3d{0.3, -0.7, 0.65}), 200.0, 300.0);
    const Vec3d shift{0.375, -0.25, 0.125};
    double largest = 0.0, largest_global = 0.0;
    for (int i = 0; i < 200; ++i) {
      const Vec3d local{0.004 * i - 0.4, 0.25 - 0.0013 * i, 0.001 * i};
      const Vec3d p{static_cast<float>(local.x), static_cast<float>(local.y), static_cast<float>(local.z)};
      const double here = value_near(field, center, p), there = value_near(field, center + shift, p - shift);
      largest = std::max(largest, std::abs(here - there));
      largest_global = std::max(largest_global, std::abs(here - field.value(center + p)));
    }
    EXPECT_LT(largest, 4e-6);  // metres; heights of 8 m are floats
    EXPECT_LT(largest_global, 4e-4);
    EXPECT_GT(largest_global, 4.0 * largest);
  }
}

// Layers without a local form are evaluated at float coordinates, which are 1.5e-5 m apart at 250 m. Over
// steps of a millimetre these layers are straight, so that values along a line deviate from a straight line
// by that rounding only.
TEST(PatchField, SpotsCratersBouldersAndGaborNoiseAreRoughByTheRoundingAlone) {
  CraterLayer craters;
  craters.population = CraterPopulation{{300, std::nullopt, 5.0, 80.0, 2.0}, 1.0, 0.0, 0.0};
  BoulderLayer boulders;
  boulders.population.emplace().drawn = {2000, std::nullopt, 4.0, 30.0, 2.5};
  const std::vector<Layer> each = {spots(3.0), craters, boulders, testing::gabor_layer(0.5, 0.1)};
  for (const Layer& layer : each) {
    Recipe recipe = testing::sphere_recipe(250.0);
    recipe.layers = {layer};
    const ImplicitField field(recipe);
    std::vector<double> bends;
    for (int k = 0; k < 40; ++k) {
      const Vec3d direction = normalized(Vec3d{std::cos(0.37 * k), std::sin(0.37 * k), 0.05 * k - 1.0});
      const Vec3d center = on_surface(field, direction, 200.0, 300.0);
      const auto at = [&](int i) {
        return double{value_near(field, center, 0.001 * i * Vec3d{1, 0.6, -0.3})};
      };
      for (int i = 0; i < 20; ++i) bends.push_back(std::abs(at(i - 1) - 2.0 * at(i) + at(i + 1)));
    }
    std::sort(bends.begin(), bends.end());
    EXPECT_LT(bends[bends.size() * 95 / 100], 2e-5) << layer.index();  // 5 % may be at edges of boulders
  }
}

// A combined body is evaluated at float coordinates, which are 2^-16 m apart at 250 m. This is well below a
// cell of a centimetre.
TEST(PatchField, CentimetresOnABodyOf500Metres) {
  Recipe lone = testing::sphere_recipe(250.0), combined = lone;
  BodyOperation& operation = combined.body->operations.emplace_back();  // changes nothing
  operation.operand = {*testing::sphere_recipe(50.0).body};
  const Vec3d center = 250.0 * normalized(Vec3d{0.3, -0.7, 0.65});
  for (const auto& [recipe, metres, tilt] : {std::tuple{lone, 1e-5, 2e-5}, {combined, 5e-5, 0.01}}) {
    const ImplicitField field(recipe);
    MeshCollector patch;
    ManifoldCheck check;
    mesh_patch(PatchField(field, center), 1.28, 128, patch);
    const MeshStatistics statistics = mesh_patch(PatchField(field, center), 1.28, 128, check);
    const ManifoldReport report = check.finish();
    EXPECT_EQ(report.open_vertices, statistics.cut_vertices);
    EXPECT_TRUE(report.manifold());
    EXPECT_EQ(report.components, 1);
    for (std::size_t i = 0; i < patch.mesh.vertices.size(); ++i) {
      const Vec3d p = center + patch.mesh.vertices[i];
      ASSERT_NEAR(norm(p), 250.0, metres);  // vertices keep a thousandth of a cell from samples
      ASSERT_LT(norm(patch.mesh.normals[i] - normalized(p)), tilt);
    }
  }
}

}  // namespace
}  // namespace astrolith
