// Fades out the borders of images that do not repeat. A Fourier transform takes an image for one period of an
// endless pattern, so jumps from one border to the opposite one draw a cross over its spectrum.
//
// Moisan's periodic plus smooth decomposition serves instead where an image must keep its details at the
// borders: the periodic component has these and no cross.
#pragma once

#include <vector>

#include "estimation/gabor/image/grey_image.h"

namespace astrolith {

struct PeriodicDecomposition {
  GreyImage periodic;  // same mean as the image
  GreyImage smooth;    // zero mean; periodic + smooth = image
};

// Solves (periodic Laplacian of smooth) = v, where v holds the jumps between opposite borders and is zero
// inside (Moisan, Periodic plus smooth image decomposition, JMIV 2011, eq. 11). Both sides of the image are
// >= 2.
PeriodicDecomposition decompose_periodic(const GreyImage& image);

// Whether opposite borders continue each other along x, or along y. The bend of a column (or a row) is the
// mean of its second differences, taken without signs. Borders continue each other if they bend about as much
// as at least three separate places inside, or less. A strong stratum or a bright grain therefore does not
// hide a cut. White noise continues across any cut, which does it no harm.
double column_bend(const GreyImage& image,
                   int x);  // of column x, whose neighbours are those of an endless pattern
bool repeats_along_x(const GreyImage& image);
bool repeats_along_y(const GreyImage& image);

// The weights of n columns (or rows) where borders do not match: a raised cosine (Tukey 1967) over a tenth at
// each end.
std::vector<double> border_fading(int n);

// A taper is the product of the weights of columns and of rows. Along an axis that repeats all weights are 1.
struct BorderTaper {
  std::vector<double> columns, rows;
  bool repeats_x = false, repeats_y = false;

  void fade_columns();
  void fade_rows();
  double looks() const;  // share of independent values in the periodogram of a tapered image, (0, 1]
};
BorderTaper make_taper(const GreyImage& image);

// taper * (image - its weighted mean) / (root mean square of the taper). A stationary texture keeps its power
// at every frequency, up to leakage from its neighbours; its variance in this window may change.
GreyImage faded(const GreyImage& image, const BorderTaper& taper);

}  // namespace astrolith
