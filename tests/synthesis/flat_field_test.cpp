// Plain arrays give the bits of the field that they were made from.
#include "synthesis/flat_field.h"

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

// Local or not, masked by a layer before or not, combined in any way.
void use_somehow(LayerUse& use, int number, CounterRandom& random) {
  if (random.below(3) == 0) use.locality = Locality{.group = "some", .width = 0.1};
  if (number == 0) return;
  use.combination.kind = static_cast<Combine>(random.below(5));
  use.combination.intersection = random.below(2) == 0;
  use.combination.width = 0.01;
  use.combination.direction = {0.5, -1.0, 0.25};
  if (random.below(2) == 0) use.mask = LayerMask{.layer = "0", .from = -0.01, .to = 0.01};
}

// A body of any kernel, with or without a warp, under up to four layers, some of them local.
Recipe random_recipe(std::uint64_t seed) {
  CounterRandom random(seed);
  Recipe recipe = potato_recipe(20 + static_cast<int>(random.below(40)), seed);
  recipe.body->kernel = static_cast<Kernel>(random.below(5));
  recipe.body->groups = {{"some", {0, 3, 7}}};
  if (random.below(3) == 0) recipe.body->warp = Warp{.amplitude = 0.04, .frequency = 2.0, .octaves = 2};
  const int layers = static_cast<int>(random.below(5));
  for (int i = 0; i < layers; ++i) {
    const std::uint64_t kind = random.below(4);
    Layer layer = kind < 2    ? Layer(random_fractal(random))
                  : kind == 2 ? Layer(random_spots(random))
                              : Layer(random_sparse(random));
    std::visit(
        [&](auto& l) {
          l.name = std::to_string(i);
          if constexpr (requires { l.use; }) use_somehow(l.use, i, random);
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
  ASSERT_EQ(obstacle_to_flattening(field), "");
  const FlatFieldData data(field);
  const FlatField flat = data.view();
  CounterRandom random(seed, 1);
  const Box bounds = field.bounds();
  for (int b = 0; b < 12; ++b) {
    const Vec3d center{random.uniform(bounds.min.x, bounds.max.x), random.uniform(bounds.min.y, bounds.max.y),
                       random.uniform(bounds.min.z, bounds.max.z)};
    const double half = b < 10 ? 0.03 : 0.6;
    const FieldBlock block = field.gather(box_around(center, half));
    FlatBlocksData blocks(data.spots.size());
    blocks.add(field.gather(box_around(center, 0.01)));  // another one before it
    blocks.add(block);
    std::vector<float> x(100), y(100), z(100), value(100);
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] = static_cast<float>(center.x + 0.99 * random.uniform(-half, half));
      y[i] = static_cast<float>(center.y + 0.99 * random.uniform(-half, half));
      z[i] = static_cast<float>(center.z + 0.99 * random.uniform(-half, half));
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
  for (std::uint64_t seed = 1; seed <= 40; ++seed) expect_same_bits(random_recipe(seed), seed);
}

TEST(FlatField, NamesWhatItLacks) {
  Recipe recipe = potato_recipe(20, 1);
  EXPECT_EQ(obstacle_to_flattening(ImplicitField(recipe)), "");
  recipe.layers = {PhasorLayer{}};
  EXPECT_EQ(obstacle_to_flattening(ImplicitField(recipe)), "layers of phasor noise");
}

}  // namespace
}  // namespace astrolith
