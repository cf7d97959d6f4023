// The smooth logarithm of a spectrum that explains a periodogram best.
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
// periodic over the grid. In the logarithm speckle is equally strong everywhere, and third differences cost
// nothing on a Gaussian lobe, whose logarithm is quadratic: its peak is not blurred, as by a moving average.
// The expected Hessian is n + w^6 L^3 with the Laplacian L, diagonal in Fourier space, so that a step of
// Fisher scoring is one convolution. A w is a length in bins of 1 / sqrt(width * height) cycles per pixel:
// what is narrower is smoothed away.
class LogSpectrumSpline {
 public:
  explicit LogSpectrumSpline(const PowerSpectrum& periodogram);

  // g on the grid; the value at frequency 0 is extrapolated. `start`: a first guess, as from a smaller w; the
  // logarithm of the periodogram where empty.
  std::vector<double> fit(double w, std::vector<double> start = {}) const;

  // What a fit with this w spends and is worth.
  struct Freedom {
    double parameters = 0.0;  // a bin, in (0, 1]: mean over Fourier space of h = n / (n + w^6 L^3)
    double variance = 0.0;    // of g, from speckle of variance 1 / n: mean of h^2 / n
  };
  Freedom freedom(double w) const;

 private:
  double objective(const std::vector<double>& g, const std::vector<double>& rough) const;

  const PowerSpectrum& periodogram_;
  FourierTransform fourier_;
  std::vector<double> cubed_laplacian_;  // L^3 by frequency of the half plane that the transform keeps
};

}  // namespace astrolith
