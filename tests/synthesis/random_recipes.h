// Random recipes. Together they hold every kind of body and layer and every way of joining them.
#pragma once

#include "tests/synthesis/bodies.h"
#include "tests/synthesis/exemplars.h"

namespace astrolith::testing {

inline FractalLayer random_fractal(CounterRandom& random) {
  FractalLayer layer =
      fractal_layer(random.uniform(-0.03, 0.03), random.uniform(1, 6), 1 + static_cast<int>(random.below(5)));
  layer.noise = static_cast<Noise>(random.below(5));
  layer.scale = {1.0, random.uniform(0.5, 2), 1.5};
  layer.bias = {random.uniform(-1, 1), 0.0, 0.25};
  if (!is_worley(layer.noise) && random.below(2) == 0) layer.gradient_modulation = random.uniform(0.1, 2);
  if (random.below(3) == 0) layer.warp = Warp{.amplitude = 0.05, .frequency = 3.0, .octaves = 2};
  return layer;
}

inline SpotLayer random_spots(CounterRandom& random) {
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

inline SparseLayer random_sparse(CounterRandom& random) {
  SparseLayer layer;
  layer.amplitude = random.uniform(-0.03, 0.03);
  layer.cell_size = 0.2;
  layer.levels = 3;
  layer.merged = random.below(2) == 0;
  return layer;
}

inline PhasorLayer random_phasor(CounterRandom& random) {
  PhasorLayer layer;
  layer.amplitude = 0.01;
  layer.frequency = 6.0;
  layer.cell_size = 0.3;
  layer.profile = static_cast<PhasorProfile>(random.below(4));
  return layer;
}

inline RandomPhaseLayer random_phase(CounterRandom& random) {
  RandomPhaseLayer layer;
  layer.height_rms = 0.01;
  layer.cell_size = 0.3;
  layer.waves = 5;
  layer.randomness = random.uniform();
  return layer;
}

inline Population drawn(double greatest_diameter) {
  Population population;
  population.count = 30;
  population.least_diameter = 0.03;
  population.greatest_diameter = greatest_diameter;
  return population;
}

inline CraterLayer random_craters(CounterRandom& random) {
  CraterLayer layer;
  layer.complex_from = 0.1;
  layer.population = CraterPopulation{};
  layer.population->drawn = drawn(0.2);
  layer.population->degradation = random.uniform();
  return layer;
}

inline BoulderLayer random_boulders(CounterRandom& random) {
  BoulderLayer layer;
  layer.roughness = random.below(2) == 0 ? 0.1 : 0.0;
  layer.angularity = layer.roughness > 0.0 ? 0.7 : 0.0;
  layer.smoothing = 0.2;
  layer.population = BoulderPopulation{};
  layer.population->drawn = drawn(0.1);
  return layer;
}

constexpr std::uint64_t kLayerKinds = 10;

// A layer of a kind: the last kinds are exemplars, Gabor noise and fractals.
inline Layer make_layer(std::uint64_t kind, CounterRandom& random) {
  switch (kind) {
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
      return exemplar_layer(0.01, 0.01);
    case 7:
      return gabor_layer(0.03, 0.005);
    default:
      return random_fractal(random);
  }
}

inline Layer random_layer(CounterRandom& random) {
  const auto kind = random.below(9);
  return make_layer(kind < 6 ? kind : kind == 6 ? 6 + random.below(2) : 9, random);
}

// A body made by operations on others: one of these has a warp, and one has operations of its own.
inline void add_operations(MetaballBody& body, CounterRandom& random) {
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
    if (i == 0) operation.operand[0].subtract = {{{-0.3, 0.25, 0.0}, 0.1}};
    if (i == 1) operation.operand[0].warp = Warp{.amplitude = 0.02, .frequency = 3.0, .octaves = 1};
    if (i == 2) {
      operation.operand[0].operations.push_back({});
      operation.operand[0].operations[0].operand = {operand(0.45)};
    }
    body.operations.push_back(operation);
  }
}

// Makes a layer local or not, masks it by an earlier layer or not, and combines it in any way.
inline void use_somehow(LayerUse& use, int number, bool first_has_height, CounterRandom& random) {
  if (random.below(3) == 0) use.locality = Locality{.group = "some", .width = 0.1};
  if (number == 0) return;
  use.combination.kind = static_cast<Combine>(random.below(5));
  use.combination.intersection = random.below(2) == 0;
  use.combination.width = 0.01;
  use.combination.direction = {0.5, -1.0, 0.25};
  if (first_has_height && random.below(2) == 0) use.mask = LayerMask{.layer = "0", .from = -0.01, .to = 0.01};
}

// Adds a layer that is used somehow. Layers that are bound to the surface cannot be warped.
inline void add_layer(Recipe& recipe, Layer layer, CounterRandom& random) {
  const int number = static_cast<int>(recipe.layers.size());
  if (std::holds_alternative<GaborLayer>(layer) || std::holds_alternative<ExemplarLayer>(layer)) {
    for (Layer& before : recipe.layers) {
      LayerUse* use = find_use(before);
      if (use != nullptr && use->combination.kind == Combine::kWarp) use->combination.kind = Combine::kAdd;
    }
  }
  std::visit(
      [&](auto& l) {
        l.name = std::to_string(number);
        if constexpr (requires { l.use; }) {
          use_somehow(l.use, number, number > 0 && find_use(recipe.layers[0]) != nullptr, random);
        }
      },
      layer);
  recipe.layers.push_back(std::move(layer));
}

// Gives some populations a weight that varies over the body, clusters, or sizes by Weibull's law.
inline void place_somehow(Recipe& recipe, CounterRandom random) {
  for (std::size_t i = 0; i < recipe.layers.size(); ++i) {
    Population* drawn = find_population(recipe.layers[i]);
    if (drawn == nullptr) continue;
    const bool masked = i > 0 && find_use(recipe.layers[0]) != nullptr;
    if (masked && random.below(2) == 0) drawn->mask = LayerMask{.layer = "0", .from = -0.005, .to = 0.005};
    if (random.below(3) == 0) drawn->locality = Locality{.group = "some", .width = 0.1};
    if (random.below(3) == 0) drawn->clusters = Clusters{.number = 2, .radius = 0.05, .share = 0.7};
    if (random.below(3) == 0) drawn->weibull = WeibullSizes{.scale = 0.05, .shape = 1.5};
  }
}

// A body of any kernel, with or without a warp, under up to four layers, some of them local.
inline Recipe random_recipe(std::uint64_t seed) {
  CounterRandom random(seed);
  Recipe recipe = potato_recipe(20 + static_cast<int>(random.below(40)), seed);
  recipe.body->kernel = static_cast<Kernel>(random.below(5));
  recipe.body->groups = {{"some", {0, 3, 7}}};
  if (random.below(3) == 0) recipe.body->warp = Warp{.amplitude = 0.04, .frequency = 2.0, .octaves = 2};
  if (random.below(4) == 0) add_operations(*recipe.body, random);
  CounterRandom dents(seed, 1);
  if (dents.below(2) == 0) add_dents(*recipe.body, 1 + static_cast<int>(dents.below(20)), dents);
  for (auto layers = random.below(5); layers > 0; --layers) {
    add_layer(recipe, random_layer(random), random);
  }
  place_somehow(recipe, CounterRandom(seed, 2));
  return recipe;
}

// A random recipe on a body of any sharpness, tension and cut-off, whose layers have any height and shape.
// On top lies a layer of each kind in turn.
inline Recipe wild_recipe(std::uint64_t seed) {
  Recipe recipe = random_recipe(seed);
  CounterRandom random(seed, 3);
  MetaballBody& body = *recipe.body;
  body.cutoff_radii = random.uniform(1.2, 5.0);
  body.blend_exponent = random.uniform(0.7, 12.0);
  if (body.kernel != Kernel::kGaussian) {
    body.blend_exponent = std::max(1.0, body.blend_exponent);
    body.a = body.b = std::max(random.uniform(0.3, 3.0), least_tension(body) + 0.01);
  }
  add_layer(recipe, make_layer(seed % kLayerKinds, random), random);
  for (Layer& layer : recipe.layers) {
    if (auto* fractal = std::get_if<FractalLayer>(&layer)) {
      fractal->amplitude *= std::pow(10.0, random.uniform(-1.0, 0.7));
    } else if (auto* spots = std::get_if<SpotLayer>(&layer)) {
      spots->sigma = random.uniform(0.5, 5.0);
      spots->even = random.below(2) == 0;
      spots->reach = random.uniform(-0.5, 0.5);
    } else if (auto* exemplar = std::get_if<ExemplarLayer>(&layer)) {
      exemplar->rotation = random.below(2) == 0 ? ExemplarRotation::kAny : ExemplarRotation::kNone;
    }
  }
  return recipe;
}

}  // namespace astrolith::testing
