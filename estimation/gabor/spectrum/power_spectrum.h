// Power spectra on a discrete Fourier grid, and the periodogram of an exemplar.
#pragma once

#include <cstddef>
#include <vector>

#include "estimation/gabor/image/grey_image.h"

namespace astrolith {

// Power at every frequency of a width x height grid: |DFT|^2 / (width * height), row-major, frequency (0, 0)
// first, so that the mean over the grid is the variance (Parseval). Symmetric: power(-f) = power(f).
struct PowerSpectrum {
  int width = 0;
  int height = 0;
  std::vector<double> power;
  // Number of independent periodograms averaged into it: each value is truth * Gamma(averages) / averages.
  double averages = 1.0;

  double variance() const;
};

// |DFT|^2 / (width * height) of the image as it is, its mean removed.
PowerSpectrum power_spectrum(const GreyImage& image);

// What is done about borders that do not match.
enum class Borders {
  kTaper,              // fade them out; leave an exemplar that tiles as it is (see border_taper.h)
  kPeriodicComponent,  // take Moisan's periodic component, as in Galerne et al. 2012
};

// The periodogram from which an exemplar is fitted, mean removed. An image with a side above `largest_side`
// is cut into half-overlapping tiles of at most that side, whose periodograms are averaged (Welch 1967): less
// speckle and bounded memory, at the price of the frequencies below one cycle a tile.
PowerSpectrum exemplar_periodogram(const GreyImage& image, int largest_side = 1024,
                                   Borders borders = Borders::kTaper);

}  // namespace astrolith
