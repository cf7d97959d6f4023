// The uncorrelated channels of a colour image.
#pragma once

#include <vector>

#include "estimation/gabor/image/grey_image.h"
#include "numerics/vec3.h"

namespace astrolith {

// A photo as a sum: rgb(x) = mean of rgb + sum over its channels of axis * (image(x) - mean of image).
struct ImageChannel {
  GreyImage image;  // axis . rgb
  Vec3d axis;       // unit vector; red, green, blue
};

// The principal components of the colours. The axes are the eigenvectors of the 3 x 3 covariance over all
// pixels; the channel of the largest variance is the first. Each axis points towards brighter colours: its
// components add up to >= 0. Channels whose standard deviation is below `smallest_deviation` are left out,
// except the first. `planes` holds red, green and blue, all of the same size.
std::vector<ImageChannel> principal_channels(const std::vector<GreyImage>& planes,
                                             double smallest_deviation = 1e-3);

Vec3d mean_color(const std::vector<GreyImage>& planes);

}  // namespace astrolith
