// Chooses how strongly each part of a spectrum is smoothed.
#pragma once

#include <vector>

#include "estimation/gabor/spectrum/power_spectrum.h"

namespace astrolith {

// A spline through a periodogram.
struct SplineChoice {
  const std::vector<double>& g;  // ln S on the grid
  double parameters;             // effective parameters per bin
};

// The fractional index of a spline for each bin: `by_octave`, but for bins where the data around them prefer
// another spline. One width for a whole octave blurs a sharp peak, ring or shoulder that lies in an otherwise
// smooth octave.
//
// The Akaike criterion of spectrum_estimate.h is averaged about a bin by a Gaussian of 2 bins, over some 50
// bins. The spline with the least mean is taken where that many bins together gain more than 3. The indices
// are then blurred by 1 bin. Both numbers were chosen on synthetic spectra, with and without peaks.
std::vector<double> locally_chosen_splines(const PowerSpectrum& data,
                                           const std::vector<SplineChoice>& splines,
                                           std::vector<double> by_octave);

}  // namespace astrolith
