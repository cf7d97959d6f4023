// Power spectra on a discrete Fourier grid, their distance and their octaves, and the periodogram of an
// exemplar.
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

// The relative optimal-transport distance of the Gaussian textures with these spectra (Xia, Ferradans, Peyre
// and Aujol 2014): |sqrt(a) - sqrt(truth)| / |sqrt(truth)| over all frequencies but 0. The distance of a
// periodogram from its own smooth spectrum is about 0.48, all of it by speckle. Throws WorkError where the
// grids differ in size.
double optimal_transport_distance(const PowerSpectrum& a, const PowerSpectrum& truth);

// log2 |f| of every grid point, with |f| in bins of 1 / sqrt(width * height) cycles per pixel and at least 1.
// The whole part is the octave's number.
std::vector<double> octave_positions(const PowerSpectrum& grid);

// The sum of the power over each octave, by its number. Frequency 0 counts in none.
std::vector<double> power_by_octave(const PowerSpectrum& spectrum, const std::vector<double>& positions);

// A positive weight for every frequency of a spectrum that has power, which falls with the variance V of its
// octave as V^-1/2. The weighted spectrum has the variance of the spectrum.
//
// Pictures of a surface show its slopes, so that an octave with a thousandth of the variance of heights may
// be all that one sees. By variance alone, lobes fitted to a height map leave such octaves out. Octaves below
// 1e-6 of the variance weigh no more than those.
std::vector<double> octave_weights(const PowerSpectrum& spectrum);

}  // namespace astrolith
