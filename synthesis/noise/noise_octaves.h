// Fractal sums of noise over many points at once, and bounds of them over boxes.
#pragma once

#include <cstdint>
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

// The octaves of a sum whose argument has no coordinate above `farthest`; those so fine that float
// coordinates could not tell neighbouring cells apart (above 2^20 cells from the origin) are left out. Octave
// o has the seed hash_append(seed, first_stream + o * stream_step).
struct OctaveSeeds {
  std::uint32_t seed, first_stream = 0, stream_step = 1;
};
std::vector<NoiseOctave> make_octaves(double frequency, double amplitude, int count, double gain,
                                      double lacunarity, const OctaveSeeds& seeds, double farthest);

// The same sum for arguments that are counted from `q`: octaves whose lattices are, by their seeds, a whole
// number of cells away.
std::vector<NoiseOctave> octaves_near(Noise noise, std::vector<NoiseOctave> octaves, const Vec3d& q);

// Of |sum|.
double sum_bound(const std::vector<NoiseOctave>& octaves);
// Of |grad sum|, per unit of the argument.
double slope_bound(Noise noise, const std::vector<NoiseOctave>& octaves);

// sum[i] += amplitude noise(frequency p_i + offset).
void add_octave(Noise noise, const NoiseOctave& octave, int n, const float* x, const float* y, const float* z,
                float* sum);

// The same for simplex and Perlin noise, divided by 1 + modulation |D_i|^2 with D_i, the slope of the sum so
// far, in three arrays that this octave adds to first.
void add_modulated_octave(Noise noise, const NoiseOctave& octave, float modulation, int n, const float* x,
                          const float* y, const float* z, float* slope_x, float* slope_y, float* slope_z,
                          float* sum);

// The sum at every float point of the box, modulated or not.
Interval bound_sum(Noise noise, const std::vector<NoiseOctave>& octaves, const Box& box, bool modulated);

}  // namespace astrolith
