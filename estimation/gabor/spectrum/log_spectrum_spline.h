// The smooth log spectrum that best explains a periodogram.
#pragma once

#include <vector>

#include "estimation/gabor/spectrum/fourier_transform.h"
#include "estimation/gabor/spectrum/power_spectrum.h"

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

}  // namespace astrolith
