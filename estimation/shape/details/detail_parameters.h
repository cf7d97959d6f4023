// The 34 numbers of a body's surface details: the 31 of thesis table 4.1 and a gain for each noise.
//
// For Perlin (i = 0), simplex (1) and Worley noise (2), ten numbers each, at 10 i ..:
//   +0 weight     [0, 1]; Worley [-1, 1]: pits, or bumps between them
//   +1 frequency  logarithm; of the first octave, cycles per length unit
//   +2 octaves    1 .. 8, rounded; those finer than the finest frequency of the ranges are left out
//   +3 amplitude  logarithm; length units
//   +4 .. +6      scale of the coordinates along x, y, z, logarithm; [1/2, 2]
//   +7 .. +9      bias of the coordinates along x, y, z, length units
// and then
//   30            gradient: the gradient modulation that Perlin and simplex noise share, [0, 2]
//   31 .. 33      gain of Perlin, simplex and Worley noise, [0, 0.9]
// Lacunarity is the thesis's 1.95. Weight times amplitude is all that the surface sees; both are there
// because the table has both.
#pragma once

#include <span>
#include <vector>

#include "estimation/optimize/optimizer.h"
#include "recipe/recipe.h"

namespace astrolith {

inline constexpr std::size_t kDetailParameters = 34;
inline constexpr double kDetailLacunarity = 1.95;

// The noises in the order of their numbers.
inline constexpr Noise kDetailNoises[] = {Noise::kPerlin, Noise::kSimplex, Noise::kWorleyF1};

// What a target can tell about its details, in its length unit.
struct DetailRanges {
  double lowest_frequency = 0.0, highest_frequency = 0.0;  // of the first octave; the latter of every octave
  double least_amplitude = 0.0, largest_amplitude = 0.0;
  double bias = 1.0;  // coordinates are shifted by up to this much
};

Bounds detail_bounds(const DetailRanges& ranges);

// One noise alone, round and unshifted: where a search begins.
struct PlainNoise {
  std::size_t which = 0;  // of kDetailNoises
  double amplitude = 0.0;
  double frequency = 1.0;
  int octaves = 1;
  double gain = 0.5;
};
std::vector<double> detail_parameters(const PlainNoise& noise, const DetailRanges& ranges);

// The layers that the numbers stand for, at most one a noise in the order above; those whose weight is below
// a thousandth are left out.
std::vector<FractalLayer> detail_layers(std::span<const double> parameters, const DetailRanges& ranges);

// A bound of the slope of all layers' heights together; twice that of the noises' slopes where they are
// modulated, since heights then fall off faster. Above 1 a height may grow faster than the way outwards, and
// leave islands in the air.
double steepness(std::span<const FractalLayer> layers);

}  // namespace astrolith
