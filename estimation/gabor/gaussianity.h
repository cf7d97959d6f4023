// Is an exemplar a Gaussian texture at all? Gabor noise keeps a photo's spectrum and nothing else.
#pragma once

#include <cstdint>
#include <string>

#include "estimation/gabor/image/grey_image.h"

namespace astrolith {

// How far a photo is from a Gaussian texture, by the sizes below and not by the p-value: large photos are
// almost never exactly Gaussian.
enum class Likeness { kGaussian, kClose, kRoughly, kOutside };

struct Gaussianity {
  // Of the marginal distribution.
  double skewness = 0.0;         // 0 for a Gaussian, 2 for an exponential distribution
  double excess_kurtosis = 0.0;  // 0 for a Gaussian, 3 for a Laplace distribution
  // Of the phases, which hold all that a spectrum does not. Edges: the excess kurtosis of differences over 1,
  // 4 and 16 pixels along rows and columns, averaged; 0 for a Gaussian texture whatever its spectrum.
  double edge_kurtosis = 0.0;
  // Spread of the variance among 8 x 8 blocks of the image over the same spread in random-phase noise of the
  // same spectrum: 1 for a Gaussian texture, more where structure sits in places.
  double variance_spread = 1.0;
  // Chance that a Gaussian texture is at least as unusual in any of these: the rank of the photo among itself
  // and 99 random-phase textures of its own spectrum, whose smallest value is 0.01. Exact for textures that
  // repeat, since their phases are then exchangeable (Theiler et al. 1992).
  double p_value = 1.0;
  Likeness likeness = Likeness::kGaussian;
  std::string sentence;  // the judgement in plain words

  bool plausible() const { return likeness != Likeness::kOutside; }
};

// Tests the periodic component of the central square of at most 512 x 512 pixels. Sides >= 32, not constant.
// kGaussian: p above 0.05. kClose, kRoughly: |skewness| up to 0.5, 1; |excess kurtosis| up to 1, 2; edges up
// to 1.5, 3; spread up to 2, 4.
Gaussianity test_gaussianity(const GreyImage& image, std::uint64_t seed);

}  // namespace astrolith
