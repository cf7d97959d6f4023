// The periodogram of an image whose borders do not match, without the leakage that steep spectra suffer.
#pragma once

#include "estimation/gabor/image/grey_image.h"
#include "estimation/gabor/spectrum/power_spectrum.h"

namespace astrolith {

// Two periodograms of one tapered image. Their expectation is the true spectrum plus what leaks from other
// frequencies through the sidelobes of the taper.
struct TaperedPower {
  PowerSpectrum values;   // of the image: strong low frequencies leak upwards
  PowerSpectrum slopes;   // of its differences along x and y, |DFT|^2 summed and divided by
                          // 4 sin^2(pi fx) + 4 sin^2(pi fy): strong high frequencies leak downwards
  double variance = 0.0;  // of the image's pixels

  // Adds another image's, of the same size; and divides by a count.
  void add(const TaperedPower& other);
  void divide(double count);
};
// On the frequencies of a grid of width x height pixels, at least the image's: a larger grid has finer
// frequencies. Along such an axis the image is faded even if it tiles.
TaperedPower tapered_power(const GreyImage& image, int width, int height);

// The spectrum of less leakage. Differences whiten a steep spectrum before it is tapered (prewhitening,
// Blackman and Tukey 1958). Leakage adds power and never takes any, so in each octave of |f| that one of the
// two periodograms is taken which has less. On 256 x 256 squares of f^-4 to f^-6 the values alone are up to
// 30 times too strong, on white noise the slopes alone 2.4 times.
//
// Light from one side and slopes wider than the image have no frequency, and their variance is left out. But
// for them, the variance is that of the pixels.
PowerSpectrum least_leaky(const TaperedPower& power);

}  // namespace astrolith
