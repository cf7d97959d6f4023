// Is an exemplar a Gaussian texture at all? Gabor noise keeps a photo's spectrum and nothing else.
#pragma once

#include <cstdint>
#include <string>

#include "estimation/gabor/grey_image.h"

namespace astrolith {

struct Gaussianity {
  double skewness = 0.0;         // 0 for a Gaussian
  double excess_kurtosis = 0.0;  // 0 for a Gaussian
  // Spread of the variance among 8 x 8 blocks of the image over the same spread in random-phase noise of the
  // same spectrum: 1 for a Gaussian texture, more where structure sits in places.
  double variance_spread = 1.0;
  // Chance that random-phase noise of the same spectrum is at least as unusual, by a test with 99 of them;
  // the smallest possible value is 0.01. Large photos are almost never exactly Gaussian: read it with the
  // sizes above.
  double p_value = 1.0;
  bool plausible = true;  // the sizes are small, whatever the p-value says
  std::string sentence;   // the judgement in plain words
};

// Tests the periodic component of the central square of at most 512 x 512 pixels against surrogates that
// share its spectrum and have random phases (Theiler et al. 1992). Sides >= 32, not constant.
Gaussianity test_gaussianity(const GreyImage& image, std::uint64_t seed);

}  // namespace astrolith
