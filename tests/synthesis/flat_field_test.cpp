// Plain arrays give the bits of the field that they were made from.
#include "synthesis/flat_value.h"

#include <vector>

#include "synthesis/flat_field_data.h"
#include "tests/synthesis/bodies.h"

namespace astrolith {
namespace {

using testing::fractal_layer;
using testing::potato_recipe;

FractalLayer random_fractal(CounterRandom& random) {
  FractalLayer layer =
      fractal_layer(random.uniform(-0.03, 0.03), random.uniform(1, 6), 1 + static_cast<int>(random.below(5)));
  layer.noise = static_cast<Noise>(random.below(5));
  layer.scale = {1.0, random.uniform(0.5, 2), 1.5};
  layer.bias = {random.uniform(-1, 1), 0.0, 0.25};
  if (!is_worley(layer.noise) && random.below(2) == 0) layer.gradient_modulation = random.uniform(0.1, 2);
  if (random.below(3) == 0) layer.warp = Warp{.amplitude = 0.05, .frequency = 3.0, .octaves = 2};
  return layer;
}

SpotLayer random_spots(CounterRandom& random) {
  SpotLayer layer;
  layer.amplitude = 0.02;
  layer.size = 0.06;
  layer.cell_size = random.uniform(0.15, 0.3);
  layer.kappa = random.uniform(-0.5, 0.5);
  layer.inverted = random.below(2) == 0;
  layer.layers = 1 + static_cast<int>(random.below(3));
  layer.lattice.b = {0.4, 0.9, 0.0};
  layer.parts = {{{0.1, 0.0, 0.2}, {1.0, 0.5, 0.8}, {0, 40, 30}, 1.0},
                 {{0, 0.3, 0}, {0.5, 0.5, 0.5}, {}, -0.5}};
  return layer;
}

SparseLayer random_sparse(CounterRandom& random) {
  SparseLayer layer;
  layer.amplitude = random.uniform(-0.03, 0.03);
  layer.cell_size = 0.2;
  layer.levels = 3;
  layer.merged = random.below(2) == 0;
  return layer;
}

PhasorLayer random_phasor(CounterRandom& random) {
  PhasorLayer layer;
  layer.amplitude = 0.01;
  layer.frequency = 6.0;
  layer.cell_size = 0.3;
  layer.profile = static_cast<PhasorProfile>(random.below(4));
  return layer;
}

RandomPhaseLayer random_phase(CounterRandom& random) {
  RandomPhaseLayer layer;
  layer.height_rms = 0.01;
  layer.cell_size = 0.3;
  layer.waves = 5;
  layer.randomness = random.uniform();
  return layer;
}

Population drawn(double greatest_diameter) {
  Population population;
  population.count = 30;
  population.least_diameter = 0.03;
  population.greatest_diameter = greatest_diameter;
  return population;
}

CraterLayer random_craters(CounterRandom& random) {
  CraterLayer layer;
  layer.complex_from = 0.1;
  layer.population = CraterPopulation{};
  layer.population->drawn = drawn(0.2);
  layer.population->degradation = random.uniform();
  return layer;
}

BoulderLayer random_boulders(CounterRandom& random) {
  BoulderLayer layer;
  layer.roughness = random.below(2) == 0 ? 0.1 : 0.0;
  layer.smoothing = 0.2;
  layer.population = BoulderPopulation{};
  layer.population->drawn = drawn(0.1);
  return layer;
}

Layer random_layer(CounterRandom& random) {
  switch (random.below(9)) {
    case 0:
      return random_spots(random);
    case 1:
      return random_sparse(random);
    case 2:
      return random_phasor(random);
    case 3:
      return random_phase(random);
    case 4:
      return random_craters(random);
    case 5:
      return random_boulders(random);
    case 6:
      return testing::gabor_layer(0.03, 0.005);
    default:
      return random_fractal(random);
  }
}

// A body that operations make of others, one of which has a warp and one operations of its own.
void add_operations(MetaballBody& body, CounterRandom& random) {
  const auto operand = [&](double x) {
    MetaballBody ball;
    ball.spheres = {{{x, 0.1, 0.0}, 0.15}, {{x, -0.1, 0.1}, 0.1}};
    return ball;
  };
  for (int i = 0; i < 3; ++i) {
    BodyOperation operation;
    operation.kind = static_cast<Operator>(random.below(5));
    if (operation.kind == Operator::kIntersection) operation.kind = Operator::kDifference;
    operation.alpha = random.uniform();
    operation.width = 0.05;
    operation.bulge = -0.02;
    operation.operand = {operand(0.3 * i - 0.3)};
    if (i == 1) operation.operand[0].warp = Warp{.amplitude = 0.02, .frequency = 3.0, .octaves = 1};
    if (i == 2) {
      operation.operand[0].operations.push_back({});
      operation.operand[0].operations[0].operand = {operand(0.45)};
    }
    body.operations.push_back(operation);
  }
}

// Local or not, masked by a layer before or not, combined in any way.
void use_somehow(LayerUse& use, int number, bool first_has_height, CounterRandom& random) {
  if (random.below(3) == 0) use.locality = Locality{.group = "some", .width = 0.1};
  if (number == 0) return;
  use.combination.kind = static_cast<Combine>(random.below(5));
  use.combination.intersection = random.below(2) == 0;
  use.combination.width = 0.01;
  use.combination.direction = {0.5, -1.0, 0.25};
  if (first_has_height && random.below(2) == 0) use.mask = LayerMask{.layer = "0", .from = -0.01, .to = 0.01};
}

// A body of any kernel, with or without a warp, under up to four layers, some of them local.
Recipe random_recipe(std::uint64_t seed) {
  CounterRandom random(seed);
  Recipe recipe = potato_recipe(20 + static_cast<int>(random.below(40)), seed);
  recipe.body->kernel = static_cast<Kernel>(random.below(5));
  recipe.body->groups = {{"some", {0, 3, 7}}};
  if (random.below(3) == 0) recipe.body->warp = Warp{.amplitude = 0.04, .frequency = 2.0, .octaves = 2};
  if (random.below(4) == 0) add_operations(*recipe.body, random);
  const int layers = static_cast<int>(random.below(5));
  for (int i = 0; i < layers; ++i) {
    Layer layer = random_layer(random);
    std::visit(
        [&](auto& l) {
          l.name = std::to_string(i);
          if constexpr (requires { l.use; })
            use_somehow(l.use, i, i > 0 && use_of(recipe.layers[0]) != nullptr, random);
        },
        layer);
    recipe.layers.push_back(layer);
  }
  return recipe;
}

Box box_around(const Vec3d& p, double half) {
  return {p - Vec3d{half, half, half}, p + Vec3d{half, half, half}};
}

// Blocks of all sizes, and the bands of meshes and of normals.
void expect_same_bits(const Recipe& recipe, std::uint64_t seed) {
  const ImplicitField field(recipe);
  ASSERT_EQ(obstacle_to_flattening(field, 0.1), "");
  const FlatFieldData data(field);
  const FlatField flat = data.view();
  CounterRandom random(seed, 1);
  const Box bounds = field.bounds();
  for (int b = 0; b < 4; ++b) {
    const Vec3d center{random.uniform(bounds.min.x, bounds.max.x), random.uniform(bounds.min.y, bounds.max.y),
                       random.uniform(bounds.min.z, bounds.max.z)};
    const double half = b < 3 ? 0.03 : 0.15;
    const FieldBlock block = field.gather(box_around(center, half));
    FlatBlocksData blocks(data);
    blocks.add(field.gather(box_around(center, 0.01)));  // another one before it
    blocks.add(block);
    std::vector<float> x(60), y(60), z(60), value(60);
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] = static_cast<float>(center.x + 0.99 * random.uniform(-half, half));
      y[i] = static_cast<float>(center.y + 0.99 * random.uniform(-half, half));
      z[i] = static_cast<float>(center.z + 0.99 * random.uniform(-half, half));
    }
    std::vector<float> corners(x.size());
    block.evaluate_tetrahedra(x, y, z, corners);
    for (std::size_t i = 0; i < x.size(); i += 4) {
      const Vec3f p[] = {{x[i], y[i], z[i]},
                         {x[i + 1], y[i + 1], z[i + 1]},
                         {x[i + 2], y[i + 2], z[i + 2]},
                         {x[i + 3], y[i + 3], z[i + 3]}};
      float four[4];
      flat_tetrahedron(flat, blocks.view().block(1), p, four);
      for (std::size_t k = 0; k < 4; ++k) {
        ASSERT_EQ(math::bits_of(four[k]), math::bits_of(corners[i + k])) << seed;
      }
    }
    for (const float band : {kExactEverywhere, 0.02f, 0.0f}) {
      block.evaluate(x, y, z, value, band);
      for (std::size_t i = 0; i < x.size(); ++i) {
        const float one = flat_value(flat, blocks.view().block(1), {x[i], y[i], z[i]}, band);
        ASSERT_EQ(math::bits_of(one), math::bits_of(value[i])) << seed << " " << one << " " << value[i];
      }
    }
  }
}

TEST(FlatField, HasTheBitsOfTheField) {
  for (std::uint64_t seed = 1; seed <= 16; ++seed) expect_same_bits(random_recipe(seed), seed);
}

TEST(FlatField, NamesWhatItLacks) {
  Recipe recipe = potato_recipe(20, 1);
  recipe.layers = {testing::gabor_layer(0.01, 0.01)};
  const ImplicitField field(recipe);
  EXPECT_EQ(obstacle_to_flattening(field, 0.05), "");
  EXPECT_NE(obstacle_to_flattening(field, 2.0), "");
}

}  // namespace
}  // namespace astrolith
