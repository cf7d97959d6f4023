// What to do about borders that do not match: a Fourier transform takes an image for one period of an endless
// pattern, and jumps from one border to the other draw a cross over its spectrum.
#pragma once

#include <vector>

#include "estimation/gabor/image/grey_image.h"

namespace astrolith {

// Whether opposite borders continue each other: along x, the mean squared second difference across the border
// is no larger than the largest inside; along y the same. By chance alone an image that tiles fails twice in
// as many times as it has columns, and is tapered without need.
bool tiles_along_x(const GreyImage& image);
bool tiles_along_y(const GreyImage& image);

// Fades the image to its mean over a tenth of each side at borders that do not match, by a raised cosine
// (Tukey 1967), and leaves it as it is along an axis that tiles. Moisan's periodic component takes some of
// the lowest frequencies of a texture away with the jumps: of 128 x 128 squares cut out of larger textures
// the taper's estimate is nearer to the truth (relative OT 0.118 against 0.143 on the four-lobe spectrum,
// 0.085 against 0.120 on the ring, 0.18 against 0.16, within chance, on the steep one), and nearer to
// held-out squares of height maps.
struct TaperedImage {
  GreyImage image;     // taper * (exemplar - its weighted mean), at the variance of the exemplar
  double looks = 1.0;  // independent values of its periodogram over their number, (0, 1]
};
TaperedImage taper_borders(const GreyImage& image);

}  // namespace astrolith
