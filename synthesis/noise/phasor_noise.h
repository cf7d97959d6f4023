// Phasor noise (Tricard et al. 2019; thesis eq. 2.27 to 2.30), at one point and over many points at once.
//
//   height(p) = amplitude profile(phi(p)),
//   phi(p) = arg sum_j a(|p - p_j|) exp(2 pi i (F u_j.(p - p_j) + psi_j))
//
// Every cell of a lattice holds the same number of impulses p_j, uniformly distributed. Their directions u_j
// lie in a cone about the layer's direction. Their phases psi_j are uniform, and so phi is uniform too. The
// kernel a(d) = (1 - (d / cell)^2)^3 is nearly a Gaussian, and 0 beyond one cell. The profile is a periodic
// wave between -1 and 1 with mean 0. Unlike a sum of waves, the noise never loses contrast.
#pragma once

#include <cstdint>

#include "numerics/arrays.h"
#include "numerics/hash_random.h"
#include "numerics/interval.h"
#include "numerics/random_direction.h"
#include "numerics/scalar_math.h"
#include "recipe/recipe.h"
#include "synthesis/noise/lattice_noise.h"
#include "synthesis/noise/noise_frame.h"
#include "synthesis/noise/noise_traits.h"

namespace astrolith {

// The parameters that all kernels of a layer share. Lengths are in cells.
struct PhasorKernels {
  Vec3f direction;
  float spread, turns_per_cell;
};

// A complex sum of kernels.
struct PhasorSum {
  float real, imaginary;
};

// An impulse as a point sees it. Where `rest` is 0 it adds exactly nothing.
struct PhasorImpulse {
  float x, y, z;  // from the impulse to the point, cells
  float rest;     // 1 - d^2, or 0 beyond one cell
  std::uint32_t hash;
};

// The impulse that lies (dx, dy, dz) cells away from the cell of the point (x, y, z), in cells; `seed` draws
// it.
ASTROLITH_KERNEL PhasorImpulse phasor_impulse(float dx, float dy, float dz, std::uint32_t seed, float x,
                                              float y, float z) {
  const float cx = math::floor(x) + dx, cy = math::floor(y) + dy, cz = math::floor(z) + dz;
  const std::uint32_t h = mix_bits(lattice_point(cx, cy, cz, seed));
  const std::uint32_t h1 = mix_bits(h + 0x9e3779b9u), h2 = mix_bits(h + 0x3c6ef372u);
  const float px = (x - cx) - unit_float(h), py = (y - cy) - unit_float(h1), pz = (z - cz) - unit_float(h2);
  return {px, py, pz, math::max(0.0f, 1.0f - math::fma(px, px, math::fma(py, py, pz * pz))), h};
}

// Adds an impulse to the sum.
ASTROLITH_KERNEL PhasorSum with_phasor_impulse(const PhasorKernels& k, const PhasorImpulse& impulse,
                                               const PhasorSum& sum) {
  const auto& [px, py, pz, rest, h] = impulse;
  const float weight = rest * rest * rest;
  const std::uint32_t h3 = mix_bits(h + 0xdaa66d2bu);
  // Sixteen bits of one hash choose the height of the direction in the cone, the other sixteen its azimuth.
  // The phase has its own hash.
  const float height = static_cast<float>(h3 >> 16) * 0x1p-16f,
              azimuth = static_cast<float>(h3 & 0xffffu) * 0x1p-16f;
  const Vec3f u = direction_in_cone(k.direction, k.spread, height, azimuth);
  const float phase = unit_float(mix_bits(h + 0x78dde6e4u));
  const float turns = math::fma(k.turns_per_cell, math::fma(u.x, px, math::fma(u.y, py, u.z * pz)), phase);
  return {math::fma(weight, math::cos_turns(turns), sum.real),
          math::fma(weight, math::sin_turns(turns), sum.imaginary)};
}

// The seed of impulse j of a cell; and the offset of cell c of the 27 cells around a point, x fastest.
ASTROLITH_KERNEL std::uint32_t phasor_seed(std::uint32_t seed, int j) {
  return hash_append(seed, static_cast<std::uint32_t>(j));
}
ASTROLITH_KERNEL Vec3f phasor_cell(int c) {
  const int x = c % 3, y = c / 3 % 3, z = c / 9;
  return {static_cast<float>(x - 1), static_cast<float>(y - 1), static_cast<float>(z - 1)};
}

// The profile at a phase in turns, [-1/2, 1/2]; values in [-1, 1].
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
  static constexpr NoiseTraits kTraits{.on_surface = false,
                                       .lifts = false,
                                       .has_heights = true,
                                       .bounded_by_box = false,
                                       .local_form = false,
                                       .lists = NoiseLists::kNone};

  Vec3f low, high;  // points outside are moved to the border
  PhasorKernels kernels{};
  float inverse_cell = 0.0f, amplitude = 0.0f;
  PhasorProfile profile = PhasorProfile::kSine;
  int impulses = 0;  // number of impulses in each cell
  std::uint32_t seed = 0;
  std::uint32_t first_point = 0;  // lattice_step() of the cell that cells are counted from
  Vec3f offset{};                 // added to the coordinates in cells
  double height_bound = 0.0;      // bound of |n(p)|, length units
  NoiseDetail detail;

  // The seed of impulse j of each cell.
  ASTROLITH_HD std::uint32_t impulse_seed(int j) const { return phasor_seed(seed, j) + first_point; }
  // A point in cells.
  ASTROLITH_HD Vec3f in_cells(const Vec3f& at) const {
    const Vec3f p = moved_into(at, low, high);
    return {math::fma(p.x, inverse_cell, offset.x), math::fma(p.y, inverse_cell, offset.y),
            math::fma(p.z, inverse_cell, offset.z)};
  }
};

// `layer_index` is the layer's number in the recipe; layers of one seed are independent. The domain of the
// frame holds the surface; points outside it are moved to its border. If the domain reaches farther than 2^20
// cells from the origin, the amplitude is 0, since float coordinates could not tell cells apart. Heights have
// mean 0. Their standard deviation over the amplitude is 1/sqrt 2 for a sine, 1/sqrt 3 for a triangle and a
// sawtooth, and 1 for a square.
PhasorNoise make_noise(const PhasorLayer& layer, std::uint64_t seed, int layer_index, const NoiseFrame& frame,
                       ArrayStore& arrays);

// The height n(p), length units.
ASTROLITH_HD inline float height_at(const PhasorNoise& n, const ArrayView&, const Vec3f& at) {
  const Vec3f p = n.in_cells(at);
  PhasorSum sum{};
  for (int c = 0; c < 27; ++c) {
    const Vec3f cell = phasor_cell(c);
    for (int j = 0; j < n.impulses; ++j) {
      const PhasorImpulse impulse = phasor_impulse(cell.x, cell.y, cell.z, n.impulse_seed(j), p.x, p.y, p.z);
      if (impulse.rest > 0.0f) sum = with_phasor_impulse(n.kernels, impulse, sum);
    }
  }
  return n.amplitude * phasor_profile(n.profile, math::atan2_turns(sum.imaginary, sum.real));
}

// Writes height[i] = n(p_i), length units. The loop is vectorised and gives the same bits as height_at.
void evaluate_heights(const PhasorNoise& n, const ArrayView& arrays, int count, const float* x,
                      const float* y, const float* z, float* height);

// Writes turns[i] = phi(p_i) in turns, [-1/2, 1/2].
void evaluate_phases(const PhasorNoise& n, int count, const float* x, const float* y, const float* z,
                     float* turns);

// An interval that holds n(p) for every point, length units. It does not depend on the box.
ASTROLITH_HD inline Interval bound_heights(const PhasorNoise& n, const ArrayView&, const Box&) {
  return {-n.height_bound, n.height_bound};
}

}  // namespace astrolith
