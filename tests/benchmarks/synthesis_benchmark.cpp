// Measures the rates of the parts of the field on one thread. Items per second are points (simplex, fBm,
// surface noise), points times spheres (metaballs) or pixels (texture).
#include <benchmark/benchmark.h>

#include "numerics/parallel_for.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/gabor/gabor_texture.h"
#include "synthesis/noise/fractal_noise.h"
#include "synthesis/noise/lone_noise.h"
#include "synthesis/spots/spot_noise.h"
#include "tests/synthesis/bodies.h"

namespace astrolith {
namespace {

constexpr int kPoints = 4096;

struct Row {
  std::vector<float> x = std::vector<float>(kPoints), y = x, z = x;
  Row() {
    for (std::size_t i = 0; i < kPoints; ++i) {
      x[i] = 0.01f * static_cast<float>(i);
      y[i] = 0.3f;
      z[i] = 0.7f;
    }
  }
};

void fractal(benchmark::State& state) {
  const Row row;
  Box domain;
  domain.extend({-100, -100, -100});
  domain.extend({100, 100, 100});
  FractalLayer layer = testing::fractal_layer(1.0, 1.0, static_cast<int>(state.range(1)));
  layer.noise = static_cast<Noise>(state.range(0));
  layer.gradient_modulation = 0.1 * static_cast<double>(state.range(2));
  const LoneNoise<FractalNoise> noise(layer, 1, 0, domain);
  std::vector<float> height(kPoints);
  for (auto _ : state) {
    noise.evaluate(kPoints, row.x.data(), row.y.data(), row.z.data(), height.data());
    benchmark::DoNotOptimize(height.data());
  }
  state.SetItemsProcessed(state.iterations() * kPoints);
}
// The argument chooses the noise: 0 simplex, 1 Perlin, 2 to 4 Worley F1, F2 and F2-F1.
BENCHMARK(fractal)
    ->ArgNames({"noise", "octaves", "modulated"})
    ->ArgsProduct({{0, 1, 2, 3, 4}, {1, 5}, {0}})
    ->ArgsProduct({{0, 1}, {5}, {1}});

// A block of samples a tenth of a cell apart, with craters of three sizes with rims.
void spots(benchmark::State& state) {
  SpotLayer layer;
  layer.amplitude = 1.0;
  layer.size = 0.3;
  layer.cell_size = 1.0;
  layer.kappa = -0.5;
  layer.layers = 3;
  const LoneNoise<SpotNoise> noise(layer, 1, 0, {{-100, -100, -100}, {100, 100, 100}});
  std::vector<float> x, y, z, height(729);
  for (int i = 0; i < 729; ++i) {
    x.push_back(0.1f * static_cast<float>(i % 9));
    y.push_back(0.1f * static_cast<float>(i / 9 % 9));
    z.push_back(0.1f * static_cast<float>(i / 81));
  }
  for (auto _ : state) {
    noise.evaluate(729, x.data(), y.data(), z.data(), height.data());
    benchmark::DoNotOptimize(height.data());
  }
  state.SetItemsProcessed(state.iterations() * 729);
}
BENCHMARK(spots);

void metaballs(benchmark::State& state) {
  const Row row;
  const auto count = static_cast<int>(state.range(0));
  const PreparedMetaballs body = prepare_metaballs(*testing::potato_recipe(count, 3).body);
  std::vector<float> s(kPoints), gx(kPoints), gy(kPoints), gz(kPoints);
  for (auto _ : state) {
    evaluate_metaballs(body, kPoints, row.x.data(), row.y.data(), row.z.data(), s.data(), gx.data(),
                       gy.data(), gz.data());
    benchmark::DoNotOptimize(s.data());
  }
  state.SetItemsProcessed(state.iterations() * kPoints * count);
}
BENCHMARK(metaballs)->ArgName("spheres")->Arg(200);

// One band with 32 impulses under a kernel, to be compared with 0.38 Mpixel/s of Lagae et al. 2009.
void gabor_texture(benchmark::State& state) {
  const ThreadLimit one_thread(1);
  GaborLayer layer;
  layer.height_rms = 1.0;
  layer.lobes = {{static_cast<int>(state.range(0)), 0.1, 0.05, 1.0}};
  for (auto _ : state) benchmark::DoNotOptimize(synthesize_texture(layer, 512, 512, {5}));
  state.SetItemsProcessed(state.iterations() * 512 * 512);
}
BENCHMARK(gabor_texture)->ArgName("bandwidth")->DenseRange(1, 7)->Unit(benchmark::kMillisecond);

// A block of 9^3 samples at the surface of a body of 200 spheres; the step is 1/256 of the length of the
// body.
void gabor_surface_block(benchmark::State& state) {
  Recipe recipe = testing::potato_recipe(200, 3);
  GaborLayer layer;
  layer.height_rms = 0.001;
  layer.pixel_size = 0.002;
  layer.lobes = {{static_cast<int>(state.range(0)), 0.1, 0.05, 1.0}};
  recipe.layers = {layer};
  const ImplicitField field(recipe);
  double surface = 0.0;
  while (field.inside({surface, 0.01, 0.02})) surface += 1e-3;
  constexpr double h = 1.0 / 256;
  const Vec3d corner{surface - 4 * h, 0.01, 0.02};
  std::vector<float> x, y, z, value(729);
  for (int i = 0; i < 729; ++i) {
    x.push_back(static_cast<float>(corner.x + h * (i % 9)));
    y.push_back(static_cast<float>(corner.y + h * (i / 9 % 9)));
    z.push_back(static_cast<float>(corner.z + h * (i / 81)));
  }
  const FieldBlock block = field.gather({corner, corner + Vec3d{8 * h, 8 * h, 8 * h}});
  for (auto _ : state) {
    block.evaluate(x, y, z, value);
    benchmark::DoNotOptimize(value.data());
  }
  state.SetItemsProcessed(state.iterations() * 729);
}
BENCHMARK(gabor_surface_block)->ArgName("bandwidth")->Arg(2)->Arg(4)->Arg(6)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace astrolith
