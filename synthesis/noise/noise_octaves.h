// Fractal sums of noise over many points at once. octave_bounds.h evaluates them at one point, and bounds
// them over boxes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "numerics/interval.h"
#include "recipe/recipe.h"

namespace astrolith {

// One octave: amplitude noise(frequency p + offset).
struct NoiseOctave {
  float frequency;
  float amplitude;  // length units
  float slope;      // lacunarity^o gain^o of octave o: its slope over that of octave 0
  std::uint32_t seed;
  Vec3f offset{};  // added to the argument, cells
};

// The seeds of a sum: octave o has the seed hash_append(seed, first_stream + o * stream_step).
struct OctaveSeeds {
  std::uint32_t seed, first_stream = 0, stream_step = 1;
};
// Octave o has the frequency frequency * lacunarity^o and the amplitude amplitude * gain^o. No coordinate of
// the argument exceeds `farthest` in magnitude. Octaves with frequency * farthest > 2^20 are left out, since
// float coordinates could not tell neighbouring cells apart.
std::vector<NoiseOctave> make_octaves(double frequency, double amplitude, int count, double gain,
                                      double lacunarity, const OctaveSeeds& seeds, double farthest);

// Octaves that give at p the sum that `octaves` give at q + p. New seeds move each lattice by a whole number
// of cells, and the offsets hold the rest. Expects |frequency q| <= kFarthestCell (noise_frame.h).
std::vector<NoiseOctave> local_octaves(Noise noise, std::span<const NoiseOctave> octaves, const Vec3d& q);

// The share of the variance of `count` octaves that those from number `kept` on have; octaves are
// independent.
double share_left_out(std::size_t kept, int count, double gain);

// A bound of |sum|, length units.
double sum_bound(std::span<const NoiseOctave> octaves);
// A bound of |grad sum|, per unit of the argument.
double slope_bound(Noise noise, std::span<const NoiseOctave> octaves);

// Adds one octave to the sums: sum[i] += amplitude noise(frequency p_i + offset).
void add_octave(Noise noise, const NoiseOctave& octave, int n, const float* x, const float* y, const float* z,
                float* sum);

// Adds one octave of simplex or Perlin noise, divided by 1 + modulation |D_i|^2. D_i is the slope of the sum
// so far; three arrays hold it. The octave adds its own slope to D_i before the division.
void add_modulated_octave(Noise noise, const NoiseOctave& octave, float modulation, int n, const float* x,
                          const float* y, const float* z, float* slope_x, float* slope_y, float* slope_z,
                          float* sum);

}  // namespace astrolith
