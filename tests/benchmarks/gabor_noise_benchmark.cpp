// Measures Gabor noise of one band with 32 impulses under a kernel on one thread. Prints one row of JSON for
// each bandwidth: pixels a second of a texture, and points a second on the surface of a sphere, in blocks as
// a mesher asks for them.
#include <cstdio>
#include <vector>

#include "numerics/parallel_for.h"
#include "synthesis/gabor/gabor_surface_noise.h"
#include "synthesis/gabor/gabor_texture.h"
#include "tests/benchmarks/processor_seconds.h"
#include "tests/synthesis/bodies.h"
#include "tests/synthesis/lone_gabor_noise.h"

namespace astrolith {
namespace {

constexpr float kFrequencyX = 0.1f, kFrequencyY = 0.05f;

GaborLayer layer_of(int bandwidth, double pixel_size) {
  GaborLayer layer;
  layer.height_rms = 1.0;
  layer.pixel_size = pixel_size;
  layer.lobes = {{bandwidth, double{kFrequencyX}, double{kFrequencyY}, 1.0}};
  return layer;
}

double texture_rate(int bandwidth) {
  constexpr int n = 1024;
  const GaborLayer layer = layer_of(bandwidth, 1.0);
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
  const testing::LoneGaborNoise noise(layer_of(bandwidth, blocks.pixel), 1, 0,
                                      *testing::sphere_recipe(1.0).body, {{-2, -2, -2}, {2, 2, 2}});
  constexpr int n = SurfaceBlocks::kSide * SurfaceBlocks::kSide;
  std::vector<float> height(n);
  return static_cast<double>(blocks.x.size()) / least_processor_seconds([&] {
           for (std::size_t i = 0; i < blocks.x.size(); i += n) {
             noise.evaluate(n, &blocks.x[i], &blocks.y[i], &blocks.z[i], height.data());
           }
         });
}

}  // namespace
}  // namespace astrolith

int main() {
  using namespace astrolith;
  const ThreadLimit one_thread(1);
  const SurfaceBlocks blocks;
  for (int bandwidth = 1; bandwidth <= 6; ++bandwidth) {
    std::printf("{\"bandwidth\": %d, \"texture\": %.2f, \"surface\": %.2f}\n", bandwidth,
                1e-6 * texture_rate(bandwidth), 1e-6 * surface_rate(blocks, bandwidth));
  }
}
