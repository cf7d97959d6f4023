// Measures noise on a grid of 256^3 points on one thread, in rows and in the blocks of 9^3 samples that a
// mesher asks for. Prints Mpoints a second as JSON. noise_peers.py runs FastNoise2 on a grid of the same
// size.
#include <cstdio>
#include <vector>

#include "synthesis/noise/fractal_noise.h"
#include "tests/benchmarks/processor_seconds.h"
#include "tests/synthesis/bodies.h"
#include "tests/synthesis/lone_noise.h"

namespace astrolith {
namespace {

constexpr int kSide = 256;
constexpr float kStep = 0.02f;

LoneNoise<FractalNoise> noise_of(Noise noise, int octaves) {
  FractalLayer layer = testing::fractal_layer(1.0, 1.0, octaves);
  layer.noise = noise;
  return {layer, 1, 0, {{-10, -10, -10}, {10, 10, 10}}};
}

// Evaluates boxes of nx x ny x nz points one after another; their coordinates are written each time.
double rate(const LoneNoise<FractalNoise>& noise, int nx, int ny, int nz, int boxes) {
  const auto n = static_cast<std::size_t>(nx * ny * nz);
  std::vector<float> x(n), y(n), z(n), height(n);
  const double seconds = least_processor_seconds([&] {
    for (int box = 0; box < boxes; ++box) {
      std::size_t i = 0;
      for (int c = 0; c < nz; ++c) {
        for (int b = 0; b < ny; ++b) {
          for (int a = 0; a < nx; ++a, ++i) {
            x[i] = kStep * static_cast<float>(a);
            y[i] = kStep * static_cast<float>(b + box % kSide);
            z[i] = kStep * static_cast<float>(c + box / kSide);
          }
        }
      }
      noise.evaluate(static_cast<int>(n), x.data(), y.data(), z.data(), height.data());
    }
  });
  return 1e-6 * static_cast<double>(n) * boxes / seconds;
}

void print(const char* name, Noise noise, int octaves) {
  const LoneNoise<FractalNoise> fractal = noise_of(noise, octaves);
  std::printf("{\"noise\": \"%s\", \"rows\": %.1f, \"blocks\": %.1f}\n", name,
              rate(fractal, kSide, 1, 1, kSide * kSide), rate(fractal, 9, 9, 9, kSide * kSide * kSide / 729));
}

}  // namespace
}  // namespace astrolith

int main() {
  using astrolith::Noise;
  astrolith::print("simplex", Noise::kSimplex, 1);
  astrolith::print("perlin", Noise::kPerlin, 1);
  astrolith::print("fbm", Noise::kSimplex, 5);
  astrolith::print("worley_f1", Noise::kWorleyF1, 1);
}
