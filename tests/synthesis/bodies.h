// Recipes that several tests of synthesis share.
#pragma once

#include <cmath>

#include "numerics/hash_random.h"
#include "recipe/recipe.h"

namespace astrolith::testing {

inline Recipe sphere_recipe(double radius, const Vec3d& center = {}) {
  Recipe recipe;
  recipe.body = MetaballBody{};
  recipe.body->spheres = {{center, radius}};
  return recipe;
}

// A potato of overlapping spheres, about 1 long, as fits make it: a few large spheres, and many small ones
// near the surface.
inline Recipe potato_recipe(int num_spheres, std::uint64_t seed, double sharpness = 3.0) {
  CounterRandom random(seed);
  Recipe recipe;
  recipe.seed = seed;
  recipe.body = MetaballBody{};
  recipe.body->blend_exponent = sharpness;
  for (int i = 0; i < num_spheres; ++i) {
    const double share = (i + 1.0) / num_spheres;
    const double radius = 0.28 * std::pow(1.0 - 0.85 * share, 1.5) + 0.02;
    Vec3d direction{random.normal(), random.normal(), random.normal()};
    direction = normalized(direction);
    const double reach = std::pow(random.uniform(), 0.4);
    recipe.body->spheres.push_back(
        {{direction.x * (0.55 - radius) * reach, direction.y * (0.36 - radius) * reach,
          direction.z * (0.33 - radius) * reach},
         radius});
  }
  return recipe;
}

// Subtractive spheres about the surface of a potato and within it.
inline void add_dents(MetaballBody& body, int count, CounterRandom& random) {
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(-0.6, 0.6), y = random.uniform(-0.4, 0.4), z = random.uniform(-0.4, 0.4);
    body.subtract.push_back({{x, y, z}, random.uniform(0.05, 0.2)});
  }
}

inline FractalLayer fractal_layer(double amplitude, double frequency, int octaves) {
  FractalLayer layer;
  layer.amplitude = amplitude;
  layer.frequency = frequency;
  layer.octaves = octaves;
  return layer;
}

// Two bands: kernels of two and of eight pixels.
inline GaborLayer gabor_layer(double pixel_size, double height_rms) {
  GaborLayer layer;
  layer.pixel_size = pixel_size;
  layer.height_rms = height_rms;
  layer.lobes = {{1, 0.2, 0.1, 1.0}, {3, -0.05, 0.1, 2.0}};
  return layer;
}

}  // namespace astrolith::testing
