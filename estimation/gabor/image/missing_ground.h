// Pixels for which a height map has no value.
#pragma once

#include "estimation/gabor/image/grey_image.h"
#include "numerics/progress.h"

namespace astrolith {

// The share of missing pixels, in [0, 1].
double missing_share(const GreyImage& image);

// The mean and the variance of the pixels that are not missing.
double known_mean(const GreyImage& image);
double known_variance(const GreyImage& image);

// Whether the image continues beyond its right border at the left one, and beyond the lower at the upper.
struct Repeats {
  bool x = false, y = false;
};

// Marks the pixels whose value is a NaN as missing and gives them the values that the others continue with:
// coarse to fine, each missing pixel becomes the mean of its four neighbours. At least one pixel is known.
// Throws WorkError where progress asks to stop.
void fill_missing(GreyImage& image, const Repeats& repeats = {}, const Progress& progress = {});

// The largest rectangle without a gap, and the first of several; the whole image where none is. Missing
// pixels are a gap where a square of 3 x 3 of them is missing: smaller holes hold what their surroundings
// say.
GreyImage largest_whole_part(const GreyImage& image);

}  // namespace astrolith
