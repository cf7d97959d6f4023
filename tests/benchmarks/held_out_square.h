// How well a fitted layer continues a photo: fit one square, compare the synthesis with the square beside it.
#pragma once

#include <cstdint>
#include <vector>

#include "estimation/gabor/gabor_fit.h"
#include "estimation/gabor/image/grey_image.h"

namespace astrolith::testing {

// Welch's estimate: 64 x 64 periodic Hann windows, half overlap, mean power; the image's mean removed first.
// Frequency 0 is zero, and the rest is scaled to unit variance, so that only the form is compared.
PowerSpectrum welch_spectrum(const GreyImage& image);

// The expectation of welch_spectrum over endless stationary textures with this spectrum: what it would be
// without the chance of one realisation. Sides are multiples of 64.
PowerSpectrum expected_welch_spectrum(const PowerSpectrum& spectrum);

// Noise with the Fourier moduli of the image's periodic component and random phases (Galerne, Gousseau and
// Morel 2011).
GreyImage random_phase_noise(const GreyImage& image, std::uint64_t seed);

// Optimal-transport distances of Welch spectra from the right square's, means over pairs of squares.
struct HeldOut {
  int pairs = 0;
  double photo = 0.0;         // of the left square itself
  double random_phase = 0.0;  // of random-phase noise of the left square, mean over seeds
  double lobes = 0.0;         // of the fitted layer's synthesis, mean over seeds
  // The same of the expected spectra: no chance of five seeds in them.
  double expected_random_phase = 0.0;
  double expected_lobes = 0.0;
  double expected_estimate = 0.0;  // of the estimated spectrum, before lobes
  double variance_ratio = 0.0;     // of the synthesis over the fitted square
  double lobe_count = 0.0;
  double seconds = 0.0;  // of a fit
  double largest_gap = 0.0;
  std::size_t largest_recipe = 0;  // bytes
};

// Pairs of squares lie side by side about the photo's vertical middle: as many, up to four, as fit above each
// other, evenly spread.
HeldOut measure_held_out(const GreyImage& photo, int side, int seeds, const GaborFitOptions& options);

}  // namespace astrolith::testing
