// Bodies whose details are known, for tests and benchmarks.
#pragma once

#include <cmath>
#include <vector>

#include "estimation/shape/target/target_body.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/noise/fractal_noise.h"
#include "tests/support/points.h"
#include "tests/synthesis/lone_noise.h"

namespace astrolith::testing {

// A body about 4.2 long.
inline MetaballBody three_spheres() {
  MetaballBody body;
  body.blend_exponent = 2.5;
  body.spheres = {{{-0.9, 0, 0}, 0.9}, {{0.5, 0.2, 0}, 1.0}, {{1.3, 0.5, 0.3}, 0.6}};
  return body;
}

// The mesh of three_spheres with layers, as a target. The seed is that of the noise.
inline TargetBody with_details(const std::vector<FractalLayer>& layers, int resolution,
                               std::uint64_t seed = 77) {
  Recipe recipe;
  recipe.seed = seed;
  recipe.body = three_spheres();
  for (const FractalLayer& layer : layers) recipe.layers.push_back(layer);
  const ImplicitField field(recipe);
  MeshCollector collector;
  mesh_field(field, field.bounds(), resolution, collector);
  return prepare_target(std::move(collector.mesh), "body with details");
}

// Two measures of layers that can be recovered from a surface. Parameters cannot: sums of different noises
// and octaves may look alike.
struct MeasuredLayers {
  double height = 0.0;     // root mean square height
  double frequency = 0.0;  // root mean square slope over 2 pi times the height
};

inline MeasuredLayers measured(const std::vector<FractalLayer>& layers) {
  const Box domain{{-3, -3, -3}, {3, 3, 3}};
  const int n = 20000;
  const float step = 1e-3f;
  CounterRandom random(5);
  std::vector<float> at(n), beside(n), sum(n, 0.0f), sum_beside(n, 0.0f);
  const auto [x, y, z] = FloatPoints(random, cube_about_origin(2.0), at.size());
  std::vector<float> shifted = x;
  for (float& v : shifted) v += step;
  for (std::size_t k = 0; k < layers.size(); ++k) {
    const LoneNoise<FractalNoise> noise(layers[k], 1, static_cast<int>(k), domain);
    noise.evaluate(n, x.data(), y.data(), z.data(), at.data());
    noise.evaluate(n, shifted.data(), y.data(), z.data(), beside.data());
    for (std::size_t i = 0; i < sum.size(); ++i) {
      sum[i] += at[i];
      sum_beside[i] += beside[i];
    }
  }
  double mean = 0.0, squares = 0.0, slopes = 0.0;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    mean += double{sum[i]} / n;
    squares += double{sum[i]} * double{sum[i]} / n;
    slopes += std::pow((double{sum_beside[i]} - double{sum[i]}) / double{step}, 2) / n;
  }
  const double height = std::sqrt(squares - mean * mean);
  return {height, std::sqrt(3.0 * slopes) / height / 6.283185307179586};
}

}  // namespace astrolith::testing
