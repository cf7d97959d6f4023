// How far two spectra of one grid are apart.
#pragma once

#include "estimation/gabor/power_spectrum.h"

namespace astrolith {

// Relative optimal-transport distance of the Gaussian textures with these spectra (Xia, Ferradans, Peyre and
// Aujol 2014): |sqrt(a) - sqrt(truth)| / |sqrt(truth)| over all frequencies but 0. Of a periodogram from its
// own smooth spectrum: about 0.48, all of it speckle.
double optimal_transport_distance(const PowerSpectrum& a, const PowerSpectrum& truth);

// |a - truth| / |truth|: ruled by the peaks.
double relative_l2_distance(const PowerSpectrum& a, const PowerSpectrum& truth);

}  // namespace astrolith
