#include "synthesis/phasor_noise.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "numerics/hash_random.h"
#include "numerics/scalar_math.h"
#include "synthesis/largest_coordinate.h"
#include "synthesis/lattice_noise.h"
#include "synthesis/random_direction.h"

namespace astrolith {
namespace {

constexpr int kChunk = 128;
using Chunk = std::array<float, kChunk>;
constexpr double kLargestCell = 1048576.0;  // 2^20

// What all kernels of a layer share; lengths in cells.
struct Kernels {
  Vec3f direction;
  float spread, turns_per_cell;
};

// real, imaginary += the k-th impulse of the cell (dx, dy, dz) away from each point's; points in cells.
ASTROLITH_SIMD_CLONES void add_impulse(const Kernels& kernels, float dx, float dy, float dz,
                                       std::uint32_t seed, int n, const float* __restrict x,
                                       const float* __restrict y, const float* __restrict z,
                                       float* __restrict real, float* __restrict imaginary) {
  const Kernels k = kernels;
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    const float cx = math::floor(x[i]) + dx, cy = math::floor(y[i]) + dy, cz = math::floor(z[i]) + dz;
    const std::uint32_t h = mix_bits(lattice_point(cx, cy, cz, seed));
    const std::uint32_t h1 = mix_bits(h + 0x9e3779b9u), h2 = mix_bits(h + 0x3c6ef372u);
    const std::uint32_t h3 = mix_bits(h + 0xdaa66d2bu);
    const float px = (x[i] - cx) - unit_float(h), py = (y[i] - cy) - unit_float(h1),
                pz = (z[i] - cz) - unit_float(h2);
    const float rest = math::max(0.0f, 1.0f - math::fma(px, px, math::fma(py, py, pz * pz)));
    const float weight = rest * rest * rest;
    // Sixteen bits place the direction's height in the cap, as many its azimuth; the phase has a hash of its
    // own.
    const float height = static_cast<float>(h3 >> 16) * 0x1p-16f,
                azimuth = static_cast<float>(h3 & 0xffffu) * 0x1p-16f;
    const Vec3f u = direction_in_cone(k.direction, k.spread, height, azimuth);
    const float phase = unit_float(mix_bits(h + 0x78dde6e4u));
    const float turns = math::fma(k.turns_per_cell, math::fma(u.x, px, math::fma(u.y, py, u.z * pz)), phase);
    real[i] = math::fma(weight, math::cos_turns(turns), real[i]);
    imaginary[i] = math::fma(weight, math::sin_turns(turns), imaginary[i]);
  }
}

// A profile at a phase in turns, [-1/2, 1/2].
float profile_at(PhasorProfile profile, float turns) {
  switch (profile) {
    case PhasorProfile::kTriangle:
      return 1.0f - 4.0f * math::abs(turns);
    case PhasorProfile::kSawtooth:
      return 2.0f * turns;
    case PhasorProfile::kSquare:
      return turns < 0.0f ? -1.0f : 1.0f;
    default:
      return math::sin_turns(turns);
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
  const Kernels kernels{direction_, spread_, turns_per_cell_};
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
        add_impulse(kernels, static_cast<float>(c % 3 - 1), static_cast<float>(c / 3 % 3 - 1),
                    static_cast<float>(c / 9 - 1), hash_append(seed_, static_cast<std::uint32_t>(j)), size,
                    px.data(), py.data(), pz.data(), real.data(), imaginary.data());
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
  for (int i = 0; i < n; ++i) height[i] = amplitude_ * profile_at(profile_, height[i]);
}

}  // namespace astrolith
