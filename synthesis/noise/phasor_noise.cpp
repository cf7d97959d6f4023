#include "synthesis/noise/phasor_noise.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "synthesis/noise/points_in_domain.h"

namespace astrolith {
namespace {

constexpr int kChunk = 128;
using Chunk = std::array<float, kChunk>;

// Adds one impulse to the sums at n points, in cells. The impulse lies (dx, dy, dz) cells away from the cell
// of each point.
ASTROLITH_SIMD_CLONES void add_impulse(const PhasorKernels& kernels, float dx, float dy, float dz,
                                       std::uint32_t seed, int n, const float* __restrict x,
                                       const float* __restrict y, const float* __restrict z,
                                       float* __restrict real, float* __restrict imaginary) {
  const PhasorKernels k = kernels;
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    const PhasorSum sum = with_phasor_impulse(k, dx, dy, dz, seed, x[i], y[i], z[i], {real[i], imaginary[i]});
    real[i] = sum.real;
    imaginary[i] = sum.imaginary;
  }
}

}  // namespace

PhasorNoise make_noise(const PhasorLayer& layer, std::uint64_t seed, int layer_index, const Box& domain,
                       ArrayStore&) {
  PhasorNoise noise;
  noise.low = to_float(domain.min);
  noise.high = to_float(domain.max);
  noise.kernels = {to_float(normalized(layer.direction)), static_cast<float>(layer.spread),
                   static_cast<float>(layer.frequency * layer.cell_size)};
  noise.inverse_cell = static_cast<float>(1.0 / layer.cell_size);
  const bool too_fine = largest_coordinate(domain) / layer.cell_size > kLargestCell;
  noise.amplitude = too_fine ? 0.0f : static_cast<float>(layer.amplitude);
  noise.profile = layer.profile;
  noise.impulses = layer.impulses_per_cell;
  noise.seed = hash_seed(seed, static_cast<std::uint32_t>(layer_index));
  noise.height_bound = std::fabs(layer.amplitude) * (1.0 + 1e-6);
  return noise;
}

void evaluate_phases(const PhasorNoise& n, int count, const float* x, const float* y, const float* z,
                     float* turns) {
  Chunk px{}, py{}, pz{}, real, imaginary;
  for (int begin = 0; begin < count; begin += kChunk) {
    const int size = std::min(kChunk, count - begin);
    for (int i = 0; i < size; ++i) {
      const auto k = static_cast<std::size_t>(i);
      px[k] = math::clamp(x[begin + i], n.low.x, n.high.x) * n.inverse_cell;
      py[k] = math::clamp(y[begin + i], n.low.y, n.high.y) * n.inverse_cell;
      pz[k] = math::clamp(z[begin + i], n.low.z, n.high.z) * n.inverse_cell;
    }
    real.fill(0.0f);
    imaginary.fill(0.0f);
    for (int c = 0; c < 27; ++c) {
      for (int j = 0; j < n.impulses; ++j) {
        const Vec3f cell = phasor_cell(c);
        add_impulse(n.kernels, cell.x, cell.y, cell.z, phasor_seed(n.seed, j), size, px.data(), py.data(),
                    pz.data(), real.data(), imaginary.data());
      }
    }
    for (int i = 0; i < size; ++i) {
      const auto k = static_cast<std::size_t>(i);
      turns[begin + i] = math::atan2_turns(imaginary[k], real[k]);
    }
  }
}

void evaluate_heights(const PhasorNoise& n, const ArrayView&, int count, const float* x, const float* y,
                      const float* z, float* height) {
  evaluate_phases(n, count, x, y, z, height);
  for (int i = 0; i < count; ++i) height[i] = n.amplitude * phasor_profile(n.profile, height[i]);
}

}  // namespace astrolith
