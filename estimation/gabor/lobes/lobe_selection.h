// Selects the few lobes of a layer from the many lobes of basis pursuit.
#pragma once

#include <vector>

#include "estimation/gabor/pursuit/basis_pursuit.h"
#include "estimation/gabor/spectrum/power_spectrum.h"
#include "numerics/progress.h"

namespace astrolith {

// height * (g(f - c) + g(f + c)) with a Gaussian g of unit peak, c = (x, y) in cycles per pixel.
struct SpectralLobe {
  int bandwidth = 0;
  double x = 0.0;
  double y = 0.0;
  double height = 0.0;  // power, > 0
};

// The lobes of the atoms with a positive coefficient; x has dictionary.size() values.
std::vector<SpectralLobe> active_lobes(const GaborDictionary& dictionary, const std::vector<double>& x);

// Refits the heights to the spectrum without the penalty, which had pulled them down (debiasing). The fit is
// a non-negative least squares of weight * (model - spectrum), with the weights of the dictionary. Then lobes
// are removed one by one until at most max_lobes are left. Each time the lobe goes whose removal raises the
// sum of squares least, after all others are refitted. So the first to go is a lobe whose neighbour can
// replace it. Throws WorkError when progress asks to stop.
std::vector<SpectralLobe> select_lobes(std::vector<SpectralLobe> lobes, const PowerSpectrum& spectrum,
                                       const std::vector<double>& weight, int max_lobes,
                                       const Progress& progress = {});

// The lobes of the largest variances as they are, for work that was stopped.
std::vector<SpectralLobe> strongest_lobes(std::vector<SpectralLobe> lobes, int max_lobes, int width,
                                          int height);

// The variance that a lobe adds to a texture of width x height pixels: its mean over the grid, frequency 0
// included.
double lobe_variance(const SpectralLobe& lobe, int width, int height);

// The sum of a layer's lobes on a width x height grid. Frequency 0 holds no power.
PowerSpectrum layer_spectrum(const std::vector<GaborLobe>& lobes, int width, int height);

}  // namespace astrolith
