// Estimates a spectrum from its periodogram, and the smooth log spectrum that best explains a periodogram.
#pragma once

#include <vector>

#include "estimation/gabor/spectrum/fourier_transform.h"
#include "estimation/gabor/spectrum/power_spectrum.h"
#include "numerics/progress.h"

namespace astrolith {

// Splines g = ln S of any smoothness through one periodogram I with n independent looks: the minimiser of
// Whittle's negative log likelihood and a roughness penalty (Wahba, Automatic smoothing of the log
// periodogram, JASA 1980; Pawitan and O'Sullivan, Nonparametric spectral density estimation using penalized
// Whittle likelihood, JASA 1994),
//
//   sum over f != 0 of n (g + I exp(-g))  +  1/2 w^6 |third differences of g|^2,
//
// periodic over the grid. In the logarithm speckle is equally strong everywhere. A Gaussian lobe has a
// quadratic logarithm, whose third differences are zero, so its peak is not blurred as it would be by a
// moving average. The expected Hessian is n + w^6 L^3 with the Laplacian L. It is diagonal in Fourier space,
// so a step of Fisher scoring is one convolution. w is a length in bins of 1 / sqrt(width * height) cycles
// per pixel: narrower features of the spectrum are smoothed away.
class LogSpectrumSpline {
 public:
  explicit LogSpectrumSpline(const PowerSpectrum& periodogram);  // which must outlive the spline

  // g on the grid, row-major; the value at frequency 0 is extrapolated. w > 0. `start` is a first guess, such
  // as the fit with a smaller w. If it is empty, the fit starts from the logarithm of the periodogram. Throws
  // WorkError when progress asks to stop.
  std::vector<double> fit(double w, std::vector<double> start = {}, const Progress& progress = {}) const;

  // The degrees of freedom of a fit, with h = n / (n + w^6 L^3).
  struct Freedom {
    double parameters = 0.0;  // effective parameters per bin, in (0, 1]: mean of h over Fourier space
    double variance = 0.0;    // variance of g from speckle of variance 1 / n: mean of h^2 / n
  };
  Freedom freedom(double w) const;

 private:
  const PowerSpectrum& periodogram_;
  FourierTransform fourier_;
  std::vector<double> cubed_laplacian_;  // L^3 by frequency of the half plane that the transform keeps
};

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
