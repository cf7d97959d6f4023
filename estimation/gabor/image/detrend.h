// Removes slow changes of brightness across a photo, such as light that falls off to one side.
#pragma once

#include <string>

#include "estimation/gabor/image/grey_image.h"

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

}  // namespace astrolith
