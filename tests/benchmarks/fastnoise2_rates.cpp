// Measures FastNoise2 on a grid of 256^3 points on one thread. Prints Mpoints a second as JSON, in the form
// of noise_benchmark. speed_table.py compiles this file, since FastNoise2 comes in no package.
#include <FastNoise/FastNoise.h>

#include <cstdio>
#include <vector>

#include "tests/benchmarks/processor_seconds.h"

namespace {

constexpr int kSide = 256;
constexpr float kStep = 0.02f;  // the step of noise_benchmark's points, in cells

void print(const char* name, const FastNoise::SmartNode<>& noise) {
  std::vector<float> values(static_cast<std::size_t>(kSide) * kSide * kSide);
  const double seconds = astrolith::least_processor_seconds(
      [&] { noise->GenUniformGrid3D(values.data(), 0, 0, 0, kSide, kSide, kSide, kStep, kStep, kStep, 1); });
  std::printf("{\"noise\": \"%s\", \"rows\": %.1f}\n", name,
              1e-6 * static_cast<double>(values.size()) / seconds);
}

// A noise whose cell is one unit wide.
template <typename Noise>
FastNoise::SmartNode<Noise> unit_cell_noise() {
  auto noise = FastNoise::New<Noise>();
  noise->SetScale(1.0f);
  return noise;
}

}  // namespace

int main() {
  const auto simplex = unit_cell_noise<FastNoise::Simplex>();
  auto fbm = FastNoise::New<FastNoise::FractalFBm>();
  fbm->SetSource(simplex);
  fbm->SetOctaveCount(5);
  fbm->SetLacunarity(2.0f);
  fbm->SetGain(0.5f);
  auto worley = unit_cell_noise<FastNoise::CellularDistance>();
  worley->SetDistanceFunction(FastNoise::DistanceFunction::Euclidean);
  print("simplex", simplex);
  print("perlin", unit_cell_noise<FastNoise::Perlin>());
  print("fbm", fbm);
  print("worley_f1", worley);
}
