// From the many lobes of basis pursuit to the few of a layer.
#pragma once

#include <vector>

#include "estimation/gabor/pursuit/basis_pursuit.h"
#include "estimation/gabor/spectrum/power_spectrum.h"

namespace astrolith {

// height * (g(f - c) + g(f + c)) with a Gaussian g of unit peak, c = (x, y) in cycles per pixel.
struct SpectralLobe {
  int bandwidth = 0;
  double x = 0.0;
  double y = 0.0;
  double height = 0.0;  // power, > 0
};

// The lobes with a positive coefficient.
std::vector<SpectralLobe> lobes_of(const GaborDictionary& dictionary, const std::vector<double>& x);

// Refits the heights to the spectrum without the penalty, which had pulled them down (debiasing):
// non-negative least squares of weight * (model - spectrum), weight as in the dictionary. Then removes, one
// at a time, the lobe whose removal raises that sum least, all others refitted, until at most max_lobes are
// left. Neighbours that stand in for each other go first.
std::vector<SpectralLobe> select_lobes(std::vector<SpectralLobe> lobes, const PowerSpectrum& spectrum,
                                       const std::vector<double>& weight, int max_lobes);

// What a lobe adds to the variance of a texture: its mean over the grid, frequency 0 included.
double lobe_variance(const SpectralLobe& lobe, int width, int height);

// The sum of a layer's lobes on the grid; frequency 0, which no image of this size shows, holds no power.
PowerSpectrum spectrum_of(const std::vector<GaborLobe>& lobes, int width, int height);

}  // namespace astrolith
