// The uncorrelated channels of a colour image, and photos without slow changes of brightness, such as light
// that falls off to one side.
#pragma once

#include <string>
#include <vector>

#include "estimation/gabor/image/grey_image.h"
#include "numerics/vec3.h"

namespace astrolith {

enum class TrendModel {
  kAdded,       // v - t + mean(t), for a slope or an uneven zero level of a height map
  kMultiplied,  // v mean(t) / t, for uneven light, which scales the contrast with the brightness
};

inline constexpr int kLargestTrendDegree = 6;

// Fits the polynomial t(x, y) = sum over i + j <= degree of c_ij P_i(x) P_j(y) to all pixels v by least
// squares and removes it. mean(t) is the image's mean. The P_i are orthonormal over the pixels of a row (Gram
// polynomials), so c_ij = sum of v P_i P_j. The trend holds about the frequencies below degree/2 cycles per
// image. degree is 1 .. kLargestTrendDegree, and both sides are > degree. Throws InputError, which names the
// image, where kMultiplied meets a trend that falls below a tenth of its mean.
void remove_trend(GreyImage& image, int degree, TrendModel model, const std::string& name);

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
