// Phasor noise (Tricard et al. 2019; thesis eq. 2.27 to 2.30), at one point and over many points at once.
//
//   height(p) = amplitude profile(phi(p)),      phi(p) = arg sum_j a(|p - p_j|) exp(2 pi i (F u_j.(p - p_j) +
//   psi_j))
// Impulses p_j are as many in each cell of a lattice, uniform in it, with directions u_j about the layer's
// and uniform phases psi_j, so that phi is uniform too. a(d) = (1 - (d / cell)^2)^3, nearly a Gaussian, is 0
// beyond a cell. The profile is a wave of one turn between -1 and 1 with no mean: contrast never fades.
#pragma once

#include <cstdint>

#include "numerics/arrays.h"
#include "numerics/hash_random.h"
#include "numerics/interval.h"
#include "numerics/random_direction.h"
#include "numerics/scalar_math.h"
#include "recipe/recipe.h"
#include "synthesis/noise/lattice_noise.h"

namespace astrolith {

// What all kernels of a layer share; lengths in cells.
struct PhasorKernels {
  Vec3f direction;
  float spread, turns_per_cell;
};

// A sum of kernels.
struct PhasorSum {
  float real, imaginary;
};

// The sum and the impulse of the cell (dx, dy, dz) away from a point's that a seed draws; the point in cells.
ASTROLITH_KERNEL PhasorSum with_phasor_impulse(const PhasorKernels& k, float dx, float dy, float dz,
                                               std::uint32_t seed, float x, float y, float z,
                                               const PhasorSum& sum) {
  const float cx = math::floor(x) + dx, cy = math::floor(y) + dy, cz = math::floor(z) + dz;
  const std::uint32_t h = mix_bits(lattice_point(cx, cy, cz, seed));
  const std::uint32_t h1 = mix_bits(h + 0x9e3779b9u), h2 = mix_bits(h + 0x3c6ef372u);
  const std::uint32_t h3 = mix_bits(h + 0xdaa66d2bu);
  const float px = (x - cx) - unit_float(h), py = (y - cy) - unit_float(h1), pz = (z - cz) - unit_float(h2);
  const float rest = math::max(0.0f, 1.0f - math::fma(px, px, math::fma(py, py, pz * pz)));
  const float weight = rest * rest * rest;
  // Sixteen bits place the direction's height in the cap, as many its azimuth; the phase has a hash of its
  // own.
  const float height = static_cast<float>(h3 >> 16) * 0x1p-16f,
              azimuth = static_cast<float>(h3 & 0xffffu) * 0x1p-16f;
  const Vec3f u = direction_in_cone(k.direction, k.spread, height, azimuth);
  const float phase = unit_float(mix_bits(h + 0x78dde6e4u));
  const float turns = math::fma(k.turns_per_cell, math::fma(u.x, px, math::fma(u.y, py, u.z * pz)), phase);
  return {math::fma(weight, math::cos_turns(turns), sum.real),
          math::fma(weight, math::sin_turns(turns), sum.imaginary)};
}

// The seed of impulse j, and the number of cell c of the 27 around a point, counted along x first.
ASTROLITH_KERNEL std::uint32_t phasor_seed(std::uint32_t seed, int j) {
  return hash_append(seed, static_cast<std::uint32_t>(j));
}
ASTROLITH_KERNEL Vec3f phasor_cell(int c) {
  return {static_cast<float>(c % 3 - 1), static_cast<float>(c / 3 % 3 - 1), static_cast<float>(c / 9 - 1)};
}

// The profile at a phase in turns, [-1/2, 1/2].
ASTROLITH_HD inline float phasor_profile(PhasorProfile profile, float turns) {
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

struct PhasorNoise {
  Vec3f low, high;  // points outside are moved to the border
  PhasorKernels kernels{};
  float inverse_cell = 0.0f, amplitude = 0.0f;
  PhasorProfile profile = PhasorProfile::kSine;
  int impulses = 0;  // a cell
  std::uint32_t seed = 0;
  double height_bound = 0.0;  // |n(p)| never exceeds it, length units
};

// `layer_index` is the layer's number in the recipe: layers of one seed are independent. Points outside
// `domain`, where no surface is, are moved to its border. Where the domain reaches beyond 2^20 cells from the
// origin, where float coordinates could not tell cells apart, there is no noise. Heights are 0 on average;
// their standard deviation over the amplitude is 1/sqrt 2 for a sine, 1/sqrt 3 for a triangle and a sawtooth,
// 1 for a square.
PhasorNoise make_noise(const PhasorLayer& layer, std::uint64_t seed, int layer_index, const Box& domain,
                       ArrayStore& arrays);

// n(p), length units.
ASTROLITH_HD inline float height_at(const PhasorNoise& n, const ArrayView&, const Vec3f& at) {
  const Vec3f p = moved_into(at, n.low, n.high);
  const float x = p.x * n.inverse_cell, y = p.y * n.inverse_cell, z = p.z * n.inverse_cell;
  PhasorSum sum{};
  for (int c = 0; c < 27; ++c) {
    const Vec3f cell = phasor_cell(c);
    for (int j = 0; j < n.impulses; ++j) {
      sum = with_phasor_impulse(n.kernels, cell.x, cell.y, cell.z, phasor_seed(n.seed, j), x, y, z, sum);
    }
  }
  return n.amplitude * phasor_profile(n.profile, math::atan2_turns(sum.imaginary, sum.real));
}

// height[i] = n(p_i): the bits of height_at, vectorised.
void evaluate_heights(const PhasorNoise& n, const ArrayView& arrays, int count, const float* x,
                      const float* y, const float* z, float* height);

// The phase phi(p_i) in turns, [-1/2, 1/2].
void evaluate_phases(const PhasorNoise& n, int count, const float* x, const float* y, const float* z,
                     float* turns);

ASTROLITH_HD inline Interval bound_heights(const PhasorNoise& n, const ArrayView&, const Box&) {
  return {-n.height_bound, n.height_bound};
}

}  // namespace astrolith
