// Octaves of frequencies, and weights by which each of them counts.
#pragma once

#include <vector>

#include "estimation/gabor/spectrum/power_spectrum.h"

namespace astrolith {

// log2 |f| of every grid point, with |f| in bins of 1 / sqrt(width * height) cycles per pixel and at least 1.
// The whole part is the octave's number.
std::vector<double> octave_positions(const PowerSpectrum& grid);

// The sum of the power over each octave, by its number. Frequency 0 counts in none.
std::vector<double> power_by_octave(const PowerSpectrum& spectrum, const std::vector<double>& positions);

// A positive weight for every frequency of a spectrum that has power, which falls with the variance V of its
// octave as V^-1/2. The weighted spectrum has the variance of the spectrum.
//
// Pictures of a surface show its slopes, so that an octave with a thousandth of the variance of heights may
// be all that one sees. By variance alone, lobes fitted to a height map leave such octaves out. Octaves below
// 1e-6 of the variance weigh no more than those.
std::vector<double> octave_weights(const PowerSpectrum& spectrum);

}  // namespace astrolith
