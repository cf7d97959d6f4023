// Measures Gabor noise of one band with 32 impulses under a kernel on one thread, beside the evaluation of
// Lagae et al. 2009 (lagae_gabor_noise.h). Prints one row of JSON for each bandwidth: pixels a second of a
// texture, and points a second on the surface of a sphere, in blocks as a mesher asks for them.
#include <cmath>
#include <cstdio>
#include <vector>

#include "numerics/parallel_for.h"
#include "synthesis/gabor/gabor_surface_noise.h"
#include "synthesis/gabor/gabor_texture.h"
#include "tests/benchmarks/lagae_gabor_noise.h"
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

testing::LagaeGaborNoise peer_of(int bandwidth) {
  const auto a = static_cast<float>(std::ldexp(std::sqrt(M_PI / (2.0 * std::log(2.0))), -bandwidth));
  return {a, kFrequencyX, kFrequencyY, 32.0f};
}

double texture_rate(int bandwidth) {
  constexpr int n = 1024;
  const GaborLayer layer = layer_of(bandwidth, 1.0);
  return n * n / least_processor_seconds([&] { synthesize_texture(layer, n, n, {5}); });
}

double peer_texture_rate(int bandwidth) {
  constexpr int n = 128;
  const testing::LagaeGaborNoise peer = peer_of(bandwidth);
  volatile float sink = 0.0f;
  return n * n / least_processor_seconds([&] {
           float sum = 0.0f;
           for (int i = 0; i < n * n; ++i)
             sum += peer.on_plane(static_cast<float>(i % n), static_cast<float>(i / n));
           sink = sum;
         });
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

double peer_surface_rate(const SurfaceBlocks& blocks, int bandwidth) {
  const testing::LagaeGaborNoise peer = peer_of(bandwidth);
  constexpr int kPoints = 4096;
  volatile float sink = 0.0f;
  return kPoints / least_processor_seconds([&] {
           float sum = 0.0f;
           for (std::size_t i = 0; i < kPoints; ++i) {
             const auto scale = static_cast<float>(1.0 / blocks.pixel);
             const float p[3] = {scale * blocks.x[i], scale * blocks.y[i], scale * blocks.z[i]};
             const float u[3] = {0.0f, 1.0f, 0.0f}, v[3] = {0.0f, 0.0f, 1.0f};
             sum += peer.on_surface(p, u, v);
           }
           sink = sum;
         });
}

}  // namespace
}  // namespace astrolith

int main() {
  using namespace astrolith;
  const ThreadLimit one_thread(1);
  const SurfaceBlocks blocks;
  for (int bandwidth = 1; bandwidth <= 6; ++bandwidth) {
    const double texture = texture_rate(bandwidth), peer = peer_texture_rate(bandwidth);
    const double surface = surface_rate(blocks, bandwidth),
                 peer_surface = peer_surface_rate(blocks, bandwidth);
    std::printf(
        "{\"bandwidth\": %d, \"texture_mpixel_per_s\": %.2f, \"peer_texture\": %.3f, "
        "\"texture_ratio\": %.1f, \"surface_mpoint_per_s\": %.2f, \"peer_surface\": %.3f, "
        "\"surface_ratio\": %.1f}\n",
        bandwidth, 1e-6 * texture, 1e-6 * peer, texture / peer, 1e-6 * surface, 1e-6 * peer_surface,
        surface / peer_surface);
  }
}
