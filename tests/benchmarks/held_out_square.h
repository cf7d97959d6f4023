// Measures how well a fitted layer continues a photo: one square is fitted, and the synthesis is compared
// with the square beside it.
#pragma once

#include <cstdint>
#include <vector>

#include "estimation/gabor/gabor_fit.h"
#include "estimation/gabor/image/grey_image.h"

namespace astrolith::testing {

// Welch's estimate of the spectrum: 64 x 64 periodic Hann windows, half overlap, mean power; the mean of the
// image is removed first. Frequency 0 is set to zero and the rest is scaled to unit variance, so that only
// the form is compared.
PowerSpectrum welch_spectrum(const GreyImage& image);

// The expectation of welch_spectrum over endless stationary textures with this spectrum, without the chance
// of a single realisation. Sides are multiples of 64.
PowerSpectrum expected_welch_spectrum(const PowerSpectrum& spectrum);

// Noise with the Fourier moduli of the image's periodic component and random phases (Galerne, Gousseau and
// Morel 2011).
GreyImage random_phase_noise(const GreyImage& image, std::uint64_t seed);

// Optimal-transport distances of Welch spectra from the spectrum of the right square, as means over pairs of
// squares.
struct HeldOut {
  int pairs = 0;
  double photo = 0.0;         // distance of the left square itself
  double random_phase = 0.0;  // random-phase noise of the left square, mean over seeds
  double lobes = 0.0;         // synthesis of the fitted layer, mean over seeds
  // Distances of the expected spectra, which do not depend on the chance of five seeds.
  double expected_random_phase = 0.0;
  double expected_lobes = 0.0;
  double expected_estimate = 0.0;  // estimated spectrum, before lobes are fitted
  double variance_ratio = 0.0;     // variance of the synthesis over that of the fitted square
  double lobe_count = 0.0;
  double seconds = 0.0;  // duration of a fit
  double largest_gap = 0.0;
  std::size_t largest_recipe = 0;  // bytes
};

// Pairs of squares lie side by side about the vertical middle of the photo. As many pairs as fit above each
// other are used, up to four, evenly spread.
HeldOut measure_held_out(const GreyImage& photo, int side, int seeds, const GaborFitOptions& options);

}  // namespace astrolith::testing
