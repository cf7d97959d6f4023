// Every example recipe has a description and becomes a closed manifold at any resolution. Random recipes
// become closed manifolds too.
#include <array>
#include <cmath>
#include <filesystem>

#include "geometry/mesh_topology.h"
#include "recipe/recipe_json.h"
#include "synthesis/field/bare_body.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/field/implicit_field.h"
#include "tests/support/test_size.h"
#include "tests/synthesis/bodies.h"

namespace astrolith {
namespace {

TEST(Examples, BecomeClosedManifolds) {
  const std::array resolutions = testing::by_size(std::array{17, 33, 52}, std::array{64, 128, 256});
  int examples = 0;
  for (const auto& entry : std::filesystem::directory_iterator(ASTROLITH_EXAMPLES)) {
    SCOPED_TRACE(entry.path().filename());
    const Recipe recipe = read_recipe(entry.path());
    EXPECT_FALSE(recipe.description.empty());
    EXPECT_EQ(recipe_to_json(parse_recipe(recipe_to_json(recipe), "r")), recipe_to_json(recipe));
    const ImplicitField field(recipe);
    for (const int resolution : resolutions) {
      MeshCollector collector;
      mesh_field(field, field.bounds(), resolution, collector);
      const MeshTopology topology = analyze_topology(collector.mesh);
      EXPECT_TRUE(topology.closed && topology.manifold && topology.oriented);
      EXPECT_GT(collector.mesh.triangles.size(), 100u);
      RecordProperty(
          entry.path().stem().string() + "_" + std::to_string(resolution),
          "genus " + std::to_string(topology.genus) + ", components " + std::to_string(topology.components));
    }
    ++examples;
  }
  EXPECT_GE(examples, 5);
}

SpotLayer random_spots(CounterRandom& random) {
  SpotLayer layer;
  layer.amplitude = random.uniform(-0.1, 0.1);
  layer.size = random.uniform(0.02, 0.15);
  layer.cell_size = layer.size * random.uniform(2.5, 6.0);
  layer.kappa = random.uniform(-1.0, 1.0);
  layer.sigma = random.uniform(0.5, 5.0);
  layer.layers = 1 + static_cast<int>(random.below(3));
  return layer;
}

FractalLayer random_fractal(CounterRandom& random) {
  FractalLayer layer = testing::fractal_layer(std::pow(10.0, random.uniform(-3, -0.8)), random.uniform(1, 12),
                                              1 + static_cast<int>(random.below(6)));
  layer.noise = static_cast<Noise>(random.below(5));
  if (!is_worley(layer.noise)) layer.gradient_modulation = random.uniform(0.0, 0.5);
  if (random.uniform() < 0.3) layer.warp = Warp{random.uniform(-0.2, 0.2), random.uniform(1, 5), 2, 0.5, 2.0};
  return layer;
}

Population random_population(CounterRandom& random, double body) {
  Population population;
  population.count = static_cast<int>(random.below(60));
  population.least_diameter = body * random.uniform(0.02, 0.1);
  population.greatest_diameter = body * random.uniform(0.1, 0.4);
  return population;
}

CraterLayer random_craters(CounterRandom& random, double body) {
  CraterLayer layer;
  layer.complex_from = body * random.uniform(0.05, 0.4);
  layer.simple.smoothing = random.uniform();
  layer.simple.depth = random.uniform(0.0, 0.3);
  layer.population =
      CraterPopulation{random_population(random, body), 1.0, random.uniform(), random.uniform()};
  return layer;
}

BoulderLayer random_boulders(CounterRandom& random, double body) {
  BoulderLayer layer;
  layer.smoothing = random.uniform();
  layer.roughness = random.uniform(0.0, 0.5);
  layer.population.emplace().drawn = random_population(random, body);
  return layer;
}

SparseLayer random_sparse(CounterRandom& random) {
  SparseLayer layer;
  layer.amplitude = random.uniform(-0.1, 0.1);
  layer.cell_size = random.uniform(0.1, 0.5);
  layer.levels = 1 + static_cast<int>(random.below(4));
  layer.merged = random.uniform() < 0.5;
  return layer;
}

// Adds craters, boulders and sparse noise. They are drawn after all else, so that the other layers of a seed
// stay as they are.
void add_features(CounterRandom& random, Recipe& recipe) {
  const BareSurface surface(bare_body(recipe));
  if (surface.empty()) return;
  const double body = surface.longest_side();
  if (random.uniform() < 0.25) recipe.layers.emplace_back(random_craters(random, body));
  if (random.uniform() < 0.25) recipe.layers.emplace_back(random_boulders(random, body));
  if (random.uniform() < 0.25) recipe.layers.emplace_back(random_sparse(random));
}

RandomPhaseLayer random_waves(CounterRandom& random) {
  RandomPhaseLayer layer;
  layer.height_rms = random.uniform(0.0, 0.03);
  layer.cell_size = random.uniform(0.1, 0.6);
  layer.frequency_max = random.uniform(1.0, 9.0);
  layer.randomness = random.uniform();
  layer.spread = random.uniform();
  return layer;
}

PhasorLayer random_phasor(CounterRandom& random) {
  PhasorLayer layer;
  layer.amplitude = random.uniform(-0.05, 0.05);
  layer.frequency = random.uniform(1.0, 8.0);
  layer.cell_size = random.uniform(0.1, 0.6);
  layer.profile = kPhasorProfiles[random.below(4)];
  return layer;
}

// Chooses a kernel, and a tension that is valid for it.
void choose_kernel(CounterRandom& random, MetaballBody& body) {
  body.kernel = kKernels[random.below(5)];
  if (body.kernel == Kernel::kGaussian) return;
  body.blend_exponent = std::max(1.0, body.blend_exponent);
  body.a = body.b = std::max(random.uniform(0.3, 3.0), least_tension(body) + 0.01);
}

// Chooses how layers join the layers before them, and by which layers they are masked. Masks need the names
// of layers.
void choose_joins(CounterRandom& random, Recipe& recipe) {
  for (std::size_t i = 0; i < recipe.layers.size(); ++i) {
    std::visit([&](auto& l) { l.name = std::to_string(i); }, recipe.layers[i]);
    LayerUse& use = *use_of(recipe.layers[i]);
    use.combination.kind = kCombines[random.below(5)];
    use.combination.width = random.uniform(0.0, 0.05);
    use.combination.intersection = random.uniform() < 0.5;
    use.combination.direction = {random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)};
    if (i > 0) use.mask = LayerMask{std::to_string(random.below(i)), -0.03, 0.03};
  }
}

void add_operation(CounterRandom& random, MetaballBody& body) {
  BodyOperation operation;
  operation.kind = kOperators[random.below(5)];
  operation.alpha = random.uniform(-0.5, 1.0);
  operation.width = random.uniform(0.02, 0.2);
  operation.bulge = random.uniform(-0.02, 0.02);
  operation.reach[0] = operation.reach[1] = 0.1;
  operation.operand = {*testing::potato_recipe(5, random.next()).body};
  for (Sphere& s : operation.operand[0].spheres) s.center.x += 0.3;
  body.operations.push_back(std::move(operation));
}

// Makes some spots of several ellipsoids on oblique lattices.
void compose_spots(CounterRandom& random, Recipe& recipe) {
  for (Layer& layer : recipe.layers) {
    auto* spots = std::get_if<SpotLayer>(&layer);
    if (spots == nullptr || random.uniform() < 0.5) continue;
    spots->even = random.uniform() < 0.5;
    spots->reach = random.uniform(-0.5, 0.5);
    spots->lattice.b = {random.uniform(-0.5, 0.5), 1.0, 0.0};
    SpotPart& part = spots->parts.emplace_back();
    part.axes = {random.uniform(0.3, 0.8), random.uniform(0.3, 0.8), random.uniform(0.3, 0.8)};
    part.turn = {random.uniform(-90, 90), 0.0, random.uniform(-90, 90)};
    spots->parts.push_back({{random.uniform(-0.3, 0.3), 0.2, 0.0}, {0.5, 0.6, 0.7}, {}, -0.5});
  }
}

Recipe random_recipe(std::uint64_t seed) {
  CounterRandom random(seed);
  Recipe recipe =
      testing::potato_recipe(1 + static_cast<int>(random.below(60)), seed, random.uniform(0.7, 12.0));
  recipe.body->cutoff_radii = random.uniform(1.2, 5.0);
  choose_kernel(random, *recipe.body);
  if (random.uniform() < 0.3) recipe.body->warp = Warp{random.uniform(-0.15, 0.15), random.uniform(1, 6), 2};
  for (auto layers = random.below(4); layers > 0; --layers) {
    const double kind = random.uniform();
    if (kind < 0.3) {
      recipe.layers.emplace_back(random_spots(random));
    } else if (kind < 0.4) {
      recipe.layers.emplace_back(random_waves(random));
    } else if (kind < 0.5) {
      recipe.layers.emplace_back(random_phasor(random));
    } else {
      recipe.layers.emplace_back(random_fractal(random));
    }
  }
  if (random.uniform() < 0.4) {
    const int half = static_cast<int>(recipe.body->spheres.size() + 1) / 2;
    SphereGroup& group = recipe.body->groups.emplace_back(SphereGroup{"first", {}});
    for (int i = 0; i < half; ++i) group.spheres.push_back(i);
    for (Layer& layer : recipe.layers) {
      use_of(layer)->locality = Locality{"first", random.uniform(0.001, 0.1)};
    }
  }
  if (random.uniform() < 0.25) add_operation(random, *recipe.body);
  if (CounterRandom own(seed, 1); own.uniform() < 0.3) choose_joins(own, recipe);
  CounterRandom for_spots(seed, 2);
  compose_spots(for_spots, recipe);
  add_features(random, recipe);
  return recipe;
}

TEST(RandomRecipes, BecomeClosedManifolds) {
  int meshes = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    const Recipe recipe = random_recipe(seed);
    validate_recipe(recipe, "random");
    const ImplicitField field(recipe);
    if (field.bounds().empty()) continue;
    MeshCollector collector;
    mesh_field(field, field.bounds(), 12 + static_cast<int>(seed % 9), collector);
    if (collector.mesh.triangles.empty()) continue;  // a difference may leave nothing
    const MeshTopology topology = analyze_topology(collector.mesh);
    ASSERT_TRUE(topology.closed && topology.manifold && topology.oriented);
    ++meshes;
  }
  EXPECT_GT(meshes, 150);
}

}  // namespace
}  // namespace astrolith
