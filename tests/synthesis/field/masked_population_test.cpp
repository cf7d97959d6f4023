// Populations whose density another layer or a group of spheres rules, and populations drawn by cells, on a
// finished field.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "synthesis/field/bare_body.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/field/layer_join.h"
#include "synthesis/landforms/bare_surface.h"
#include "synthesis/landforms/boulder_field.h"
#include "synthesis/landforms/crater_relief.h"
#include "synthesis/mesh/manifold_check.h"
#include "tests/support/points.h"
#include "tests/support/refusal.h"
#include "tests/synthesis/bodies.h"

namespace astrolith {
namespace {

FractalLayer named_noise(const std::string& name, Combine kind) {
  FractalLayer layer = testing::fractal_layer(1.0, 0.8, 3);
  layer.name = name;
  layer.use.combination.kind = kind;
  return layer;
}

CraterLayer masked_craters(int count) {
  CraterLayer layer;
  Population& drawn = layer.population.emplace().drawn;
  drawn.count = count;
  drawn.least_diameter = 0.001;
  drawn.greatest_diameter = 0.002;
  drawn.mask = LayerMask{"where", -0.2, 0.3};
  return layer;
}

std::vector<Vec3d> find_places(const ImplicitField& field) {
  std::vector<Vec3d> places;
  for (const PlacedCrater& c : field.craters().front().craters) places.push_back(c.position);
  return places;
}

// The heights of a recipe's layers at points of the bare surface, where s = 0.
std::vector<double> heights_at(const Recipe& recipe, const std::vector<Vec3d>& points) {
  const ImplicitField field(recipe);
  std::vector<double> heights;
  for (const Vec3d& p : points) heights.push_back(field.value(p));
  return heights;
}

std::vector<Vec3d> uniform_places(const Recipe& recipe, int count) {
  CounterRandom random(99);
  std::vector<Vec3d> numbers;
  for (int i = 0; i < count; ++i) numbers.push_back({random.uniform(), random.uniform(), random.uniform()});
  return BareSurface(bare_body(recipe)).scatter(numbers);
}

// The mask is read as other layers read it: here at coordinates that a layer before it displaces. Expected
// counts come from the masking noise itself, drawn on a body of its own.
TEST(MaskedPopulation, DensityFollowsTheMaskingLayer) {
  Recipe recipe = testing::sphere_recipe(1.0);
  FractalLayer warp = named_noise("warp", Combine::kWarp);
  warp.use.combination.direction = {0.3, 0.1, -0.2};
  recipe.layers = {warp, named_noise("where", Combine::kMask), masked_craters(20000)};
  const std::vector<Vec3d> places = find_places(ImplicitField(recipe));
  ASSERT_EQ(places.size(), 20000u);
  Recipe shown = recipe;
  shown.layers = {warp, named_noise("where", Combine::kAdd)};
  std::get<FractalLayer>(shown.layers[1]).amplitude = 0.01;
  const LayerMask mask{"where", -0.002, 0.003};
  constexpr int kBins = 12;
  std::vector<double> expected(kBins), counts(kBins);
  const auto bin_at = [](double height) {
    return static_cast<std::size_t>(
        std::clamp(static_cast<int>((height + 0.002) / 0.005 * kBins), 0, kBins - 1));
  };
  const auto weight = [&](double height) {
    return double{smooth_step(static_cast<float>(height), -0.002f, 200.0f)};
  };
  for (const double height : heights_at(shown, uniform_places(recipe, 200000)))
    expected[bin_at(height)] += weight(height);
  for (const double height : heights_at(shown, places)) {
    ASSERT_GT(height, mask.from - 1e-5);
    ++counts[bin_at(height)];
  }
  const double whole = std::accumulate(expected.begin(), expected.end(), 0.0);
  double chi_squared = 0.0;
  int freedom = -1;
  for (int i = 0; i < kBins; ++i) {
    const double mean = expected[static_cast<std::size_t>(i)] * 20000.0 / whole;
    const double difference = counts[static_cast<std::size_t>(i)] - mean;
    if (mean < 5.0) continue;
    chi_squared += difference * difference / (1.1 * mean);  // the expected counts are sampled themselves
    ++freedom;
  }
  ASSERT_GT(freedom, 6);
  EXPECT_LT(chi_squared, freedom + 4.0 * std::sqrt(2.0 * freedom));
}

// Where the groups of two equal spheres meet, weights add up to 1: both halves have equally many.
TEST(MaskedPopulation, LocalityBindsLandformsToAGroup) {
  Recipe recipe = testing::sphere_recipe(1.0);
  recipe.body->spheres.push_back({{1.5, 0, 0}, 1.0});
  recipe.body->groups = {{"left", {0}}};
  CraterLayer craters = masked_craters(2000);
  craters.population->drawn.mask.reset();
  craters.population->drawn.locality = Locality{"left", 0.01};
  recipe.layers = {craters};
  int right = 0;
  for (const Vec3d& p : find_places(ImplicitField(recipe))) right += p.x > 0.75;
  EXPECT_GT(right, 0);
  EXPECT_LT(right, 60);  // the arctangent falls slowly
}

TEST(MaskedPopulation, LayersWithoutAHeightMaskNothing) {
  Recipe recipe = testing::sphere_recipe(1.0);
  GaborLayer flat = testing::gabor_layer(0.1, 0.0);
  flat.name = "where";
  recipe.layers = {flat, masked_craters(5)};
  EXPECT_TRUE(testing::has(testing::refusal_text([&] { const ImplicitField field(recipe, "r"); }),
                           "r: layers[1].population.mask.layer: \"where\" has no height"));
}

// With `over` a mask reads roughness: heights of a wide wave have none over a short distance, and those of a
// narrow wave have some.
TEST(MaskedPopulation, ReadsTheRoughnessOfTheMaskingLayer) {
  const auto places_by_wave = [](double frequency) {
    Recipe recipe = testing::sphere_recipe(1.0);
    FractalLayer where = named_noise("where", Combine::kMask);
    where.frequency = frequency;
    where.octaves = 1;
    CraterLayer craters = masked_craters(0);
    Population& drawn = craters.population->drawn;
    drawn.count.reset();
    drawn.density = 50.0;
    drawn.mask = LayerMask{"where", 0.05, 0.1, 0.02};
    recipe.layers = {where, craters};
    return find_places(ImplicitField(recipe)).size();
  };
  EXPECT_EQ(places_by_wave(0.8), 0u);
  EXPECT_GT(places_by_wave(20.0), 200u);
}

// A body of 500 m with craters of metres and boulders of half a metre and more, ruled by a mask.
Recipe fine_ground() {
  Recipe recipe = testing::sphere_recipe(250.0);
  FractalLayer where = named_noise("where", Combine::kAdd);
  where.amplitude = 2.0;
  where.frequency = 0.01;
  CraterLayer craters;
  CraterPopulation& pits = craters.population.emplace();
  pits.drawn.density = 0.002;
  pits.drawn.least_diameter = 2.0;
  pits.drawn.greatest_diameter = 15.0;
  pits.drawn.exponent = 1.9;
  pits.drawn.by_cells = true;
  pits.depth_deviation = 0.3;
  BoulderLayer boulders;
  boulders.roughness = boulders.smoothing = 0.1;
  boulders.population.emplace().drawn = pits.drawn;
  Population& stones = boulders.population->drawn;
  stones.density = 0.6;
  stones.exponent = 3.0;
  stones.least_diameter = 0.5;
  stones.greatest_diameter = 8.0;
  stones.mask = LayerMask{"where", -0.5, 0.5};
  recipe.layers = {where, craters, boulders};
  return recipe;
}

PatchCube cube_about(const Vec3d& direction, double side) { return {250.0 * normalized(direction), side}; }

// F at points near the surface, as a patch evaluates it in the body's frame.
std::vector<float> values_in(const ImplicitField& field, const std::vector<Vec3d>& points) {
  std::vector<float> values(points.size());
  testing::FloatPoints all;
  Box box;
  for (const Vec3d& p : points) {
    all.add(p);
    box.extend({double{all.x.back()}, double{all.y.back()}, double{all.z.back()}});
  }
  field.gather(box).evaluate(all.x, all.y, all.z, values);
  return values;
}

// Two patches that overlap have the same landforms where both lie, bit by bit.
TEST(PopulationByCellsOnAField, OverlappingPatchesAgree) {
  const Recipe recipe = fine_ground();
  const PatchCube a = cube_about({0.3, -0.5, 0.8}, 60.0);
  const PatchCube b{a.center + Vec3d{9.0, 6.0, -1.0}, 30.0};
  const ImplicitField field_a(recipe, "r", a), field_b(recipe, "r", b);
  ASSERT_GT(field_a.boulders().front().boulders.size(), 100u);
  ASSERT_LT(field_a.boulders().front().boulders.size(), 20000u);
  EXPECT_EQ(field_a.height_bound(), field_b.height_bound());
  CounterRandom random(3);
  std::vector<Vec3d> points;
  while (points.size() < 4000) {
    const Vec3d p = b.center + Vec3d{random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-5, 5)};
    points.push_back((250.0 + random.uniform(-2, 3)) / norm(p) * p);
  }
  const std::vector<float> in_a = values_in(field_a, points), in_b = values_in(field_b, points);
  for (std::size_t i = 0; i < points.size(); ++i) ASSERT_EQ(in_a[i], in_b[i]) << i;
  // Without the landforms F is another.
  Recipe bare = recipe;
  bare.layers.resize(1);
  const std::vector<float> without = values_in(ImplicitField(bare, "r", a), points);
  int changed = 0;
  for (std::size_t i = 0; i < points.size(); ++i) changed += in_a[i] != without[i];
  EXPECT_GT(changed, 50);
}

TEST(PopulationByCellsOnAField, PatchesAreManifoldAndSmallerStonesStayOut) {
  const Recipe recipe = fine_ground();
  const PatchCube cube = cube_about({0.3, -0.5, 0.8}, 20.0);
  const ImplicitField field(recipe, "r", cube);
  EXPECT_TRUE(field.left_out().empty());
  ManifoldCheck check;
  const MeshStatistics statistics = mesh_patch(PatchField(field, cube.center), cube.side, 96, check);
  const ManifoldReport report = check.finish();
  EXPECT_TRUE(report.manifold());
  EXPECT_EQ(report.open_vertices, statistics.cut_vertices);
}

// The mesh of the whole body leaves out the finest, says so, is closed, and is the same for any number of
// threads.
TEST(PopulationByCellsOnAField, WholeBodiesSayWhatTheyLack) {
  const Recipe recipe = fine_ground();
  std::vector<TriangleMesh> meshes;
  for (const int threads : {1, 3}) {
    const ThreadLimit limit(threads);
    const ImplicitField field(recipe);
    ASSERT_FALSE(field.left_out().empty());
    EXPECT_EQ(field.left_out().back().layer, 2);
    EXPECT_GT(field.left_out().back().landforms, 1e5);
    EXPECT_GT(field.left_out().back().variance_share, 0.0);
    EXPECT_LT(field.left_out().back().variance_share, 0.5);
    MeshCollector collector;
    mesh_field(field, field.bounds(), 48, collector);
    meshes.push_back(collector.mesh);
  }
  EXPECT_EQ(meshes[0].vertices, meshes[1].vertices);
  EXPECT_EQ(meshes[0].triangles, meshes[1].triangles);
  ManifoldCheck check;
  const ImplicitField field(recipe);
  mesh_field(field, field.bounds(), 48, check);
  EXPECT_TRUE(check.finish().closed());
}

}  // namespace
}  // namespace astrolith
