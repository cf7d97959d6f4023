// From a periodogram to an estimate of the spectrum behind it.
#pragma once

#include <vector>

#include "estimation/gabor/spectrum/power_spectrum.h"

namespace astrolith {

// How much an octave of frequencies was smoothed.
struct OctaveSmoothing {
  double frequency = 0.0;   // geometric centre of the octave, cycles per pixel
  double width_bins = 0.0;  // w of the spline, in bins of 1/sqrt(width * height) cycles per pixel
};

struct SpectrumEstimate {
  PowerSpectrum spectrum;  // same variance as the periodogram; positive everywhere but at frequency 0
  std::vector<OctaveSmoothing> smoothing;
  // Expected optimal-transport distance from the truth by speckle alone: the root of
  // sum S var(ln S) / 4 over sum S. 0 for an estimate that is a raw periodogram.
  double standard_error = 0.0;
};

// The periodogram of a Gaussian texture is its spectrum times exponential speckle. Its logarithm is estimated
// by splines (see LogSpectrumSpline) of smoothness w, and how smooth, the data decide: in each octave of |f|
// the w with the least Akaike criterion,
//
//   sum over the octave of n (g + I exp(-g)) + parameters a bin          (Akaike 1974, n: independent looks),
//
// with w interpolated between octaves. Peaks near frequency 0 thus stay narrow where flat regions are
// smoothed widely. Frequency 0 holds no data and is left out.
SpectrumEstimate estimate_spectrum(const PowerSpectrum& periodogram);

}  // namespace astrolith
