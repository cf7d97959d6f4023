// Estimates a spectrum from its periodogram.
#pragma once

#include <vector>

#include "estimation/gabor/spectrum/power_spectrum.h"
#include "numerics/progress.h"

namespace astrolith {

// How strongly an octave of frequencies was smoothed.
struct OctaveSmoothing {
  double frequency = 0.0;   // geometric centre of the octave, cycles per pixel
  double width_bins = 0.0;  // w of the spline, in bins of 1/sqrt(width * height) cycles per pixel
};

struct SpectrumEstimate {
  PowerSpectrum spectrum;  // same variance as the periodogram; positive everywhere but at frequency 0
  std::vector<OctaveSmoothing> smoothing;
  // The optimal-transport distance from the truth that is expected from speckle alone: the root of
  // sum S var(ln S) / 4 over sum S.
  double standard_error = 0.0;
  std::vector<double> weights;  // octave_weights of the spectrum
  // The standard error with these weights: the root of sum w S var(ln S) / 4 over sum w S.
  double weighted_error = 0.0;
};

// The periodogram I of a Gaussian texture is its spectrum times exponential speckle. The log spectrum g is
// estimated by splines (see LogSpectrumSpline) of several widths w. In each octave of |f| the data choose the
// w with the least Akaike criterion (Akaike 1974; n: independent looks),
//
//   sum over the octave of n (g + I exp(-g)) + effective parameters per bin,
//
// and w is interpolated between octaves. Peaks near frequency 0 thus stay narrow, while flat regions are
// smoothed widely. Frequency 0 holds no data and is left out. Throws WorkError when progress asks to stop.
SpectrumEstimate estimate_spectrum(const PowerSpectrum& periodogram, const Progress& progress = {});

}  // namespace astrolith
