// The 34 parameters of a body's surface details: the 31 of thesis table 4.1, and a gain for each noise.
//
// Perlin (i = 0), simplex (1) and Worley noise (2) have ten parameters each, which begin at 10 i:
//   +0 weight     [0, 1]; Worley [-1, 1]: pits, or bumps between them
//   +1 frequency  logarithm; of the first octave, cycles per length unit
//   +2 octaves    1 .. 8, rounded; octaves above the highest frequency of the ranges are left out
//   +3 amplitude  logarithm; length units
//   +4 .. +6      scale of the coordinates along x, y, z, logarithm; [1/2, 2]
//   +7 .. +9      bias of the coordinates along x, y, z, length units
// Four more follow:
//   30            gradient: the gradient modulation that Perlin and simplex noise share, [0, 2]
//   31 .. 33      gain of Perlin, simplex and Worley noise, [0, 0.9]
// The lacunarity is 1.95, as in the thesis. The surface depends on the product of weight and amplitude only.
// Both are parameters because the table has both.
#pragma once

#include <span>
#include <vector>

#include "estimation/optimize/optimizer.h"
#include "recipe/recipe.h"

namespace astrolith {

inline constexpr std::size_t kDetailParameters = 34;
inline constexpr double kDetailLacunarity = 1.95;

// The noises in the order of their parameters.
inline constexpr Noise kDetailNoises[] = {Noise::kPerlin, Noise::kSimplex, Noise::kWorleyF1};

// The ranges that a target's mesh can determine, in the target's length unit.
struct DetailRanges {
  double lowest_frequency = 0.0;   // of the first octave, cycles per length unit
  double highest_frequency = 0.0;  // of every octave
  double least_amplitude = 0.0, largest_amplitude = 0.0;
  double bias = 1.0;  // largest shift of the coordinates
};

// Lower and upper bounds of the 34 parameters.
Bounds detail_bounds(const DetailRanges& ranges);

// One noise alone, with coordinates neither scaled nor shifted. A search starts with such a noise.
struct PlainNoise {
  std::size_t which = 0;  // index into kDetailNoises
  double amplitude = 0.0;
  double frequency = 1.0;
  int octaves = 1;
  double gain = 0.5;
};

// The parameters of this noise with weight 1. The other noises have weight 0.
std::vector<double> detail_parameters(const PlainNoise& noise, const DetailRanges& ranges);

// The layers for these parameters, at most one for each noise, in the order of the noises. A noise with a
// weight below a thousandth is left out.
std::vector<FractalLayer> detail_layers(std::span<const double> parameters, const DetailRanges& ranges);

// An upper bound of the slope of the sum of all layers. Gradient modulation makes heights fall off faster, so
// the bound of a modulated noise is doubled. With a slope above 1 a height can grow faster than the distance
// from the base, which leaves islands.
double steepness(std::span<const FractalLayer> layers);

}  // namespace astrolith
