// The distance of two spectra on the same grid.
#pragma once

#include "estimation/gabor/spectrum/power_spectrum.h"

namespace astrolith {

// The relative optimal-transport distance of the Gaussian textures with these spectra (Xia, Ferradans, Peyre
// and Aujol 2014): |sqrt(a) - sqrt(truth)| / |sqrt(truth)| over all frequencies but 0. The distance of a
// periodogram from its own smooth spectrum is about 0.48, all of it by speckle. Throws WorkError where the
// grids differ in size.
double optimal_transport_distance(const PowerSpectrum& a, const PowerSpectrum& truth);

}  // namespace astrolith
