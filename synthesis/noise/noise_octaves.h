// Fractal sums of noise over many points at once. octave_sum.h has them at one point, octave_bounds.h over
// boxes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "numerics/interval.h"
#include "recipe/recipe.h"

namespace astrolith {

struct NoiseOctave {
  float frequency;
  float amplitude;  // length units
  float slope;      // of this octave over the first's, were both noises equally steep
  std::uint32_t seed;
  Vec3f offset{};  // of the coordinates, cells
};

// Octave o has the seed hash_append(seed, first_stream + o * stream_step).
struct OctaveSeeds {
  std::uint32_t seed, first_stream = 0, stream_step = 1;
};
// The octaves of a sum whose argument has no coordinate above `farthest`. Octaves so fine that float
// coordinates could not tell neighbouring cells apart (above 2^20 cells from the origin) are left out.
std::vector<NoiseOctave> make_octaves(double frequency, double amplitude, int count, double gain,
                                      double lacunarity, const OctaveSeeds& seeds, double farthest);

// Octaves that give the same sum for arguments counted from `q`: their lattices are, by their seeds, a whole
// number of cells away.
std::vector<NoiseOctave> local_octaves(Noise noise, std::span<const NoiseOctave> octaves, const Vec3d& q);

// A bound of |sum|.
double sum_bound(std::span<const NoiseOctave> octaves);
// A bound of |grad sum|, per unit of the argument.
double slope_bound(Noise noise, std::span<const NoiseOctave> octaves);

// sum[i] += amplitude noise(frequency p_i + offset).
void add_octave(Noise noise, const NoiseOctave& octave, int n, const float* x, const float* y, const float* z,
                float* sum);

// Adds an octave of simplex or Perlin noise divided by 1 + modulation |D_i|^2. D_i is the slope of the sum so
// far, in three arrays that this octave adds to first.
void add_modulated_octave(Noise noise, const NoiseOctave& octave, float modulation, int n, const float* x,
                          const float* y, const float* z, float* slope_x, float* slope_y, float* slope_z,
                          float* sum);

}  // namespace astrolith
