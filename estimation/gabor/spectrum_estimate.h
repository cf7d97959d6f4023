// From a periodogram to an estimate of the spectrum behind it.
#pragma once

#include <vector>

#include "estimation/gabor/power_spectrum.h"

namespace astrolith {

// How much an octave of frequencies was smoothed.
struct OctaveSmoothing {
  double frequency = 0.0;       // geometric centre of the octave, cycles per pixel
  double deviation_bins = 0.0;  // of the Gaussian kernel, in bins of 1/sqrt(width * height) cycles per pixel
};

struct SpectrumEstimate {
  PowerSpectrum spectrum;  // same variance as the periodogram; positive everywhere but at frequency 0
  std::vector<OctaveSmoothing> smoothing;
};

// The periodogram of a Gaussian texture is its spectrum times exponential speckle, so the spectrum is
// estimated by averaging over neighbouring frequencies. How wide, the data decide: in each octave the
// Gaussian kernel is chosen that predicts every bin best from its neighbours without itself, by Whittle's log
// likelihood sum log S + I / S (leave-one-out cross-validation). Peaks thus stay narrow where flat regions
// are smoothed widely. Frequency 0 holds no data and is left out.
SpectrumEstimate estimate_spectrum(const PowerSpectrum& periodogram);

}  // namespace astrolith
