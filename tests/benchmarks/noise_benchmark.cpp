// Measures noise on one thread, a row of JSON each: Mpoints a second on a grid of 256^3 points, in rows and
// in the blocks of 9^3 samples that a mesher asks for. fastnoise2_rates.cpp runs FastNoise2 on a grid of the
// same size.
//
//   noise_benchmark --gabor
//
// measures Gabor noise of one band with 32 impulses under a kernel: Mpixels a second of a texture, and
// Mpoints a second on the surface of a sphere, in blocks, for each bandwidth.
#include <cstdio>
#include <string_view>
#include <vector>

#include "numerics/parallel_for.h"
#include "synthesis/gabor/gabor_surface_noise.h"
#include "synthesis/gabor/gabor_texture.h"
#include "synthesis/noise/fractal_noise.h"
#include "tests/benchmarks/processor_seconds.h"
#include "tests/synthesis/bodies.h"
#include "tests/synthesis/lone_gabor_noise.h"
#include "tests/synthesis/lone_noise.h"

namespace astrolith {
namespace {

constexpr int kSide = 256;
constexpr float kStep = 0.02f;

LoneNoise<FractalNoise> make_test_noise(Noise noise, int octaves) {
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
  const LoneNoise<FractalNoise> fractal = make_test_noise(noise, octaves);
  std::printf("{\"noise\": \"%s\", \"rows\": %.1f, \"blocks\": %.1f}\n", name,
              rate(fractal, kSide, 1, 1, kSide * kSide), rate(fractal, 9, 9, 9, kSide * kSide * kSide / 729));
}

GaborLayer make_layer(int bandwidth, double pixel_size) {
  GaborLayer layer;
  layer.height_rms = 1.0;
  layer.pixel_size = pixel_size;
  layer.lobes = {{bandwidth, 0.1f, 0.05f, 1.0}};
  return layer;
}

double texture_rate(int bandwidth) {
  constexpr int n = 1024;
  const GaborLayer layer = make_layer(bandwidth, 1.0);
  return n * n / least_processor_seconds([&] { synthesize_texture(layer, n, n, {5}); });
}

// Blocks of points on a sphere; neighbouring points are a pixel apart.
struct SurfaceBlocks {
  static constexpr int kSide = 16, kBlocks = 24;
  double pixel = 5e-4;
  std::vector<float> x, y, z;

  SurfaceBlocks() {
    for (int b = 0; b < kBlocks * kBlocks; ++b) {
      for (int i = 0; i < kSide * kSide; ++i) {
        const double u = pixel * (b % kBlocks * kSide + i % kSide),
                     v = pixel * (b / kBlocks * kSide + i / kSide);
        const Vec3d p = normalized(Vec3d{1.0, u - 0.1, v + 0.2});
        x.push_back(static_cast<float>(p.x));
        y.push_back(static_cast<float>(p.y));
        z.push_back(static_cast<float>(p.z));
      }
    }
  }
};

double surface_rate(const SurfaceBlocks& blocks, int bandwidth) {
  const testing::LoneGaborNoise noise(make_layer(bandwidth, blocks.pixel), 1, 0,
                                      *testing::sphere_recipe(1.0).body, {{-2, -2, -2}, {2, 2, 2}});
  constexpr int n = SurfaceBlocks::kSide * SurfaceBlocks::kSide;
  std::vector<float> height(n);
  return static_cast<double>(blocks.x.size()) / least_processor_seconds([&] {
           for (std::size_t i = 0; i < blocks.x.size(); i += n) {
             noise.evaluate(n, &blocks.x[i], &blocks.y[i], &blocks.z[i], height.data());
           }
         });
}

void print_gabor() {
  const SurfaceBlocks blocks;
  for (int bandwidth = 1; bandwidth <= 6; ++bandwidth) {
    std::printf("{\"bandwidth\": %d, \"texture\": %.2f, \"surface\": %.2f}\n", bandwidth,
                1e-6 * texture_rate(bandwidth), 1e-6 * surface_rate(blocks, bandwidth));
  }
}

}  // namespace
}  // namespace astrolith

int main(int argc, char** argv) {
  using namespace astrolith;
  const ThreadLimit one_thread(1);
  if (argc > 1 && std::string_view(argv[1]) == "--gabor") {
    print_gabor();
  } else {
    print("simplex", Noise::kSimplex, 1);
    print("perlin", Noise::kPerlin, 1);
    print("fbm", Noise::kSimplex, 5);
    print("worley_f1", Noise::kWorleyF1, 1);
    print("worley_blocks", Noise::kWorleyBlocks, 1);
  }
}
