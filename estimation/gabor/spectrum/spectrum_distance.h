// Distances of two spectra on the same grid. All throw WorkError where the grids differ in size.
#pragma once

#include "estimation/gabor/spectrum/power_spectrum.h"

namespace astrolith {

// The relative optimal-transport distance of the Gaussian textures with these spectra (Xia, Ferradans, Peyre
// and Aujol 2014): |sqrt(a) - sqrt(truth)| / |sqrt(truth)| over all frequencies but 0. The distance of a
// periodogram from its own smooth spectrum is about 0.48, all of it by speckle.
double optimal_transport_distance(const PowerSpectrum& a, const PowerSpectrum& truth);

// |a - truth| / |truth| over all frequencies but 0. The peaks dominate it.
double relative_l2_distance(const PowerSpectrum& a, const PowerSpectrum& truth);

// The root mean square of ln(a / truth) over the frequencies where the truth is at least 1e-3 of its mean,
// since weaker frequencies are invisible in a texture. `a` is raised to at least 1e-6 of the truth's mean.
double log_spectral_distance(const PowerSpectrum& a, const PowerSpectrum& truth);

}  // namespace astrolith
