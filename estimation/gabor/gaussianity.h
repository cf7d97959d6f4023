// Tests whether an exemplar is a Gaussian texture. Gabor noise keeps the spectrum of a photo and nothing
// else.
#pragma once

#include <cstdint>
#include <string>

#include "estimation/gabor/image/grey_image.h"
#include "numerics/progress.h"

namespace astrolith {

// How far a photo is from a Gaussian texture. The measures of `Gaussianity` decide, because large photos are
// almost never Gaussian by their p-value.
enum class Likeness { kGaussian, kClose, kRoughly, kOutside };

struct Gaussianity {
  // Shape of the marginal distribution.
  double skewness = 0.0;         // 0 for a Gaussian, 2 for an exponential distribution
  double excess_kurtosis = 0.0;  // 0 for a Gaussian, 3 for a Laplace distribution
  // Edges, which only the phases hold: the excess kurtosis of differences over 1, 4 and 16 pixels along rows
  // and columns, averaged. It is 0 for a Gaussian texture with any spectrum.
  double edge_kurtosis = 0.0;
  // Spread of the variance among blocks, 8 x 8 in each piece, divided by this spread in random-phase noise
  // with the spectrum of the image. It is 1 for a Gaussian texture, and larger where structure is local.
  double variance_spread = 1.0;
  // The chance that a Gaussian texture is at least as unusual in any of these measures: the rank of the photo
  // among itself and 99 random-phase textures of its own spectrum. The smallest value is 0.01. A photo of
  // more than 16 pieces has fewer of these textures, at least 19. The test is exact for textures that repeat,
  // since their phases are exchangeable (Theiler et al. 1992).
  double p_value = 1.0;
  Likeness likeness = Likeness::kGaussian;
  std::string sentence;  // the judgement in plain words

  bool plausible() const { return likeness != Likeness::kOutside; }
};

// Tests the whole image: it is cut into equal pieces of at most 512 x 512 pixels, and the periodic components
// of all pieces are measured together. The image has sides >= 32 and is not constant. A likeness is kGaussian
// where p is above 0.05. It is kClose, or else kRoughly, where |skewness| is up to 0.5 (1), |excess kurtosis|
// up to 1 (2), edge_kurtosis up to 1.5 (3) and variance_spread up to 2 (4). An image beyond the limits of
// kRoughly is kOutside for any p. Throws WorkError when progress asks to stop.
Gaussianity test_gaussianity(const GreyImage& image, std::uint64_t seed, const Progress& progress = {});

// What of an image is tested: all of it, or of one with missing pixels the largest part without any, if its
// sides are >= 32.
GreyImage known_texture(const GreyImage& image);

}  // namespace astrolith
