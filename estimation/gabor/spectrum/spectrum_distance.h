// How far two spectra of one grid are apart.
#pragma once

#include "estimation/gabor/spectrum/power_spectrum.h"

namespace astrolith {

// Relative optimal-transport distance of the Gaussian textures with these spectra (Xia, Ferradans, Peyre and
// Aujol 2014): |sqrt(a) - sqrt(truth)| / |sqrt(truth)| over all frequencies but 0. Of a periodogram from its
// own smooth spectrum: about 0.48, all of it speckle.
double optimal_transport_distance(const PowerSpectrum& a, const PowerSpectrum& truth);

// |a - truth| / |truth|: ruled by the peaks.
double relative_l2_distance(const PowerSpectrum& a, const PowerSpectrum& truth);

// Root mean square of ln(a / truth) over the frequencies where the truth is at least 1e-3 of its mean; what
// is below counts for nothing in a texture, and neither does a below 1e-6 of that mean.
double log_spectral_distance(const PowerSpectrum& a, const PowerSpectrum& truth);

}  // namespace astrolith
