#include "synthesis/noise/phasor_noise.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "numerics/interval.h"

namespace astrolith {
namespace {

constexpr int kChunk = 128;
using Chunk = std::array<float, kChunk>;

// real, imaginary += the k-th impulse of the cell (dx, dy, dz) away from each point's; points in cells.
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

PhasorNoise::PhasorNoise(const PhasorLayer& layer, std::uint64_t seed, int layer_index, const Box& domain)
    : domain_min_(to_float(domain.min)),
      domain_max_(to_float(domain.max)),
      direction_(to_float(normalized(layer.direction))),
      inverse_cell_(static_cast<float>(1.0 / layer.cell_size)),
      turns_per_cell_(static_cast<float>(layer.frequency * layer.cell_size)),
      spread_(static_cast<float>(layer.spread)),
      amplitude_(static_cast<float>(layer.amplitude)),
      profile_(layer.profile),
      impulses_(layer.impulses_per_cell),
      seed_(hash_seed(seed, static_cast<std::uint32_t>(layer_index))),
      height_bound_(std::fabs(layer.amplitude) * (1.0 + 1e-6)) {
  if (largest_coordinate(domain) / layer.cell_size > kLargestCell) amplitude_ = 0.0f;
}

void PhasorNoise::evaluate_phase(int n, const float* x, const float* y, const float* z, float* turns) const {
  const PhasorKernels kernels{direction_, spread_, turns_per_cell_};
  Chunk px{}, py{}, pz{}, real, imaginary;
  for (int begin = 0; begin < n; begin += kChunk) {
    const int size = std::min(kChunk, n - begin);
    for (int i = 0; i < size; ++i) {
      const auto k = static_cast<std::size_t>(i);
      px[k] = math::clamp(x[begin + i], domain_min_.x, domain_max_.x) * inverse_cell_;
      py[k] = math::clamp(y[begin + i], domain_min_.y, domain_max_.y) * inverse_cell_;
      pz[k] = math::clamp(z[begin + i], domain_min_.z, domain_max_.z) * inverse_cell_;
    }
    real.fill(0.0f);
    imaginary.fill(0.0f);
    for (int c = 0; c < 27; ++c) {
      for (int j = 0; j < impulses_; ++j) {
        const Vec3f cell = phasor_cell(c);
        add_impulse(kernels, cell.x, cell.y, cell.z, phasor_seed(seed_, j), size, px.data(), py.data(),
                    pz.data(), real.data(), imaginary.data());
      }
    }
    for (int i = 0; i < size; ++i) {
      const auto k = static_cast<std::size_t>(i);
      turns[begin + i] = math::atan2_turns(imaginary[k], real[k]);
    }
  }
}

void PhasorNoise::evaluate(int n, const float* x, const float* y, const float* z, float* height) const {
  evaluate_phase(n, x, y, z, height);
  for (int i = 0; i < n; ++i) height[i] = amplitude_ * phasor_profile(profile_, height[i]);
}

}  // namespace astrolith
