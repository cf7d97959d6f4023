// Local random phase noise (Gilet et al. 2014; thesis eq. 2.25), at one point and over many points at once.
//
//   n(p) = rms / norm(p) sum_i w_i(p) sum_j A_j cos(2 pi f_j.p + phi_ij)
//
// Here i runs over the eight lattice points around p. Each window w_i is a product of cos(pi/2 fade(t)) along
// the axes, t in cells. The squares of the windows add up to 1 over the lattice, so that waves of independent
// phases have the same variance everywhere. The part of the phases that cells share adds up coherently;
// norm(p) compensates for it:
//
//   norm^2 = (1 - c) + c (sum_i w_i)^2,      c = (sin(pi r) / (pi r))^2,     r the layer's randomness.
#pragma once

#include <cstdint>

#include "numerics/arrays.h"
#include "numerics/hash_random.h"
#include "numerics/interval.h"
#include "recipe/recipe.h"
#include "synthesis/noise/noise_frame.h"
#include "synthesis/noise/noise_traits.h"
#include "synthesis/noise/perlin_noise.h"

namespace astrolith {

// One wave. Its angle at p is frequency . p + phase, in turns.
struct Wave {
  Vec3f frequency;
  float phase;
  float amplitude;  // length units
  std::uint32_t seed;
};

ASTROLITH_KERNEL float phase_window(float t) { return math::cos_turns(0.25f * quintic_fade(t)); }

// The weight of the c-th lattice point around the point (x, y, z), in cells, and the hash of the lattice
// point.
struct PhaseCorner {
  float weight;
  std::uint32_t hash;
};
ASTROLITH_KERNEL PhaseCorner phase_corner(unsigned c, float x, float y, float z, std::uint32_t seed) {
  const PerlinCell cell = perlin_cell(x, y, z, seed);
  const bool far_x = (c & 1) != 0, far_y = (c & 2) != 0, far_z = (c & 4) != 0;
  const float wx = phase_window(far_x ? 1.0f - cell.x : cell.x),
              wy = phase_window(far_y ? 1.0f - cell.y : cell.y),
              wz = phase_window(far_z ? 1.0f - cell.z : cell.z);
  const std::uint32_t step = (far_x ? kLatticeX : 0u) + (far_y ? kLatticeY : 0u) + (far_z ? kLatticeZ : 0u);
  return {wx * wy * wz, cell.first + step};
}

// The factor 1 / norm, from the sum of the weights.
ASTROLITH_KERNEL float phase_scale(float coherence, float sum) {
  return 1.0f / math::sqrt(math::fma(coherence, math::fma(sum, sum, -1.0f), 1.0f));
}

// Adds one wave to the height, with the weight and the phase of one corner.
ASTROLITH_KERNEL float with_wave(const Wave& w, float randomness, const PhaseCorner& corner, float x, float y,
                                 float z, float height) {
  const float turns = math::fma(w.frequency.x, x, math::fma(w.frequency.y, y, w.frequency.z * z));
  const float random = unit_float(mix_bits(corner.hash ^ w.seed)) - 0.5f;
  const float angle = (turns - math::round_even(turns)) + math::fma(randomness, random, w.phase);
  return math::fma(w.amplitude * corner.weight, math::cos_turns(angle), height);
}

struct RandomPhaseNoise {
  static constexpr NoiseTraits kTraits{.on_surface = false,
                                       .lifts = false,
                                       .has_heights = true,
                                       .bounded_by_box = false,
                                       .local_form = false,
                                       .lists = NoiseLists::kNone};

  Vec3f low, high;  // points outside are moved to the border
  ArrayRange<Wave> waves;
  float inverse_cell = 0.0f, randomness = 0.0f, coherence = 0.0f;
  float clip = 0.0f;          // heights are clamped to +- clip: 6 standard deviations, length units
  std::uint32_t seed = 0;     // with the lattice_step() of the cell that cells are counted from
  Vec3f offset{};             // added to the coordinates in cells
  double height_bound = 0.0;  // bound of |n(p)|, length units
  NoiseDetail detail;
};

// `layer_index` is the layer's number in the recipe; layers of one seed are independent. The domain of the
// frame holds the surface; points outside it are moved to its border. Waves of more than 2^18 turns within
// the domain are left out, since float coordinates could not hold their phases. Heights have mean 0; their
// standard deviation over seeds is height_rms.
RandomPhaseNoise make_noise(const RandomPhaseLayer& layer, std::uint64_t seed, int layer_index,
                            const NoiseFrame& frame, ArrayStore& arrays);

// The height n(p), length units.
ASTROLITH_HD inline float height_at(const RandomPhaseNoise& n, const ArrayView& arrays, const Vec3f& at) {
  const Vec3f p = moved_into(at, n.low, n.high);
  PhaseCorner corners[8];
  float weights = 0.0f;
  for (unsigned c = 0; c < 8; ++c) {
    corners[c] = phase_corner(c, math::fma(p.x, n.inverse_cell, n.offset.x),
                              math::fma(p.y, n.inverse_cell, n.offset.y),
                              math::fma(p.z, n.inverse_cell, n.offset.z), n.seed);
    weights += corners[c].weight;
  }
  const Wave* waves = arrays[n.waves];
  float height = 0.0f;
  for (std::uint32_t w = 0; w < n.waves.count; ++w) {
    for (const PhaseCorner& corner : corners) {
      height = with_wave(waves[w], n.randomness, corner, p.x, p.y, p.z, height);
    }
  }
  return math::clamp(height * phase_scale(n.coherence, weights), -n.clip, n.clip);
}

// Writes height[i] = n(p_i), length units. The loop is vectorised and gives the same bits as height_at.
void evaluate_heights(const RandomPhaseNoise& n, const ArrayView& arrays, int count, const float* x,
                      const float* y, const float* z, float* height);

// An interval that holds n(p) for every point, length units. It does not depend on the box.
ASTROLITH_HD inline Interval bound_heights(const RandomPhaseNoise& n, const ArrayView&, const Box&) {
  return {-n.height_bound, n.height_bound};
}

}  // namespace astrolith
