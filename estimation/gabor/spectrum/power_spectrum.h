// Power spectra on a discrete Fourier grid, and the periodogram of an exemplar.
#pragma once

#include <cstddef>
#include <vector>

#include "estimation/gabor/image/grey_image.h"
#include "numerics/progress.h"

namespace astrolith {

// The power at every frequency of a width x height grid, |DFT|^2 / (width * height). The grid is row-major
// and begins with frequency (0, 0). The mean over the grid is the variance (Parseval), and power(-f) =
// power(f).
struct PowerSpectrum {
  int width = 0;
  int height = 0;
  std::vector<double> power;
  // The number n of independent periodograms in this mean: each value is truth * Gamma(n) / n. A taper, under
  // which neighbours are correlated, lowers it.
  double averages = 1.0;
  // The variance of each value by itself over its squared mean: 1 for one periodogram, tapered or not.
  double scatter = 1.0;

  double variance() const;
};

// |DFT|^2 / (width * height) of the image, with its mean removed and its borders as they are.
PowerSpectrum power_spectrum(const GreyImage& image);

// The periodogram to which lobes are fitted, with the mean removed and the borders faded out, unless the
// exemplar repeats (border_taper.h). An image with a side above `largest_side` is cut into half-overlapping
// segments of at most this side, whose periodograms are averaged (Welch 1967). This lowers speckle and bounds
// memory; frequencies below one cycle per segment are lost. Reports progress before each segment, and throws
// WorkError when asked to stop.
PowerSpectrum exemplar_periodogram(const GreyImage& image, int largest_side = 1024,
                                   const Progress& progress = {});

}  // namespace astrolith
