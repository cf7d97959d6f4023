#include "synthesis/noise/phasor_noise.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace astrolith {
namespace {

// Adds one impulse to the sums at n points, in cells. The impulse lies (dx, dy, dz) cells away from the cell
// of each point. Six of seven impulses around a point do not reach it, so that runs of points that an impulse
// does not reach are passed over.
ASTROLITH_SIMD_CLONES void add_impulse(const PhasorKernels& kernels, float dx, float dy, float dz,
                                       std::uint32_t seed, int n, const float* __restrict x,
                                       const float* __restrict y, const float* __restrict z,
                                       float* __restrict real, float* __restrict imaginary) {
  constexpr int kRun = 16;
  const PhasorKernels k = kernels;
  float px[kRun], py[kRun], pz[kRun], rest[kRun];
  std::uint32_t hash[kRun];
  for (int first = 0; first < n; first += kRun) {
    const int size = n - first < kRun ? n - first : kRun;
    int reached = 0;
#pragma omp simd reduction(| : reached)
    for (int i = 0; i < size; ++i) {
      const PhasorImpulse impulse =
          phasor_impulse(dx, dy, dz, seed, x[first + i], y[first + i], z[first + i]);
      px[i] = impulse.x;
      py[i] = impulse.y;
      pz[i] = impulse.z;
      rest[i] = impulse.rest;
      hash[i] = impulse.hash;
      reached |= impulse.rest > 0.0f ? 1 : 0;
    }
    if (reached == 0) continue;
#pragma omp simd
    for (int i = 0; i < size; ++i) {
      const PhasorSum sum = with_phasor_impulse(k, {px[i], py[i], pz[i], rest[i], hash[i]},
                                                {real[first + i], imaginary[first + i]});
      real[first + i] = sum.real;
      imaginary[first + i] = sum.imaginary;
    }
  }
}

}  // namespace

PhasorNoise make_noise(const PhasorLayer& layer, std::uint64_t seed, int layer_index, const NoiseFrame& frame,
                       ArrayStore&) {
  PhasorNoise noise;
  noise.low = to_float(frame.domain.min);
  noise.high = to_float(frame.domain.max);
  noise.kernels = {to_float(normalized(layer.direction)), static_cast<float>(layer.spread),
                   static_cast<float>(layer.frequency * layer.cell_size)};
  noise.inverse_cell = static_cast<float>(1.0 / layer.cell_size);
  const bool too_fine = frame.farthest() / layer.cell_size > kLargestCell;
  if (!too_fine) {
    const OriginCell origin = origin_cell(double{noise.inverse_cell} * frame.origin);
    noise.first_point = lattice_step(origin.x, origin.y, origin.z);
    noise.offset = to_float(origin.rest);
  }
  noise.detail = {std::min(layer.cell_size, 1.0 / layer.frequency), too_fine ? 1.0 : 0.0};
  noise.amplitude = too_fine ? 0.0f : static_cast<float>(layer.amplitude);
  noise.profile = layer.profile;
  noise.impulses = layer.impulses_per_cell;
  noise.seed = hash_seed(seed, static_cast<std::uint32_t>(layer_index));
  noise.height_bound = std::fabs(layer.amplitude) * (1.0 + 1e-6);
  return noise;
}

void evaluate_phases(const PhasorNoise& n, int count, const float* x, const float* y, const float* z,
                     float* turns) {
  constexpr int kBatch = 128;
  std::array<float, kBatch> px{}, py{}, pz{}, real, imaginary;
  for (int begin = 0; begin < count; begin += kBatch) {
    const int size = std::min(kBatch, count - begin);
    for (int i = 0; i < size; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const Vec3f p = n.in_cells({x[begin + i], y[begin + i], z[begin + i]});
      px[k] = p.x;
      py[k] = p.y;
      pz[k] = p.z;
    }
    real.fill(0.0f);
    imaginary.fill(0.0f);
    for (int c = 0; c < 27; ++c) {
      for (int j = 0; j < n.impulses; ++j) {
        const Vec3f cell = phasor_cell(c);
        add_impulse(n.kernels, cell.x, cell.y, cell.z, n.impulse_seed(j), size, px.data(), py.data(),
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
