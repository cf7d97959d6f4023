// How near a texture is to a photo, pixel positions aside.
#pragma once

#include "estimation/gabor/image/grey_image.h"

namespace astrolith {

// Wasserstein-1 distances between distributions, over the standard deviation of the photo's; 0 for equal
// distributions.
struct TextureScore {
  double values = 0.0;   // of the grey values
  double filters = 0.0;  // of filter responses, the mean over all filters

  double sum() const { return values + filters; }
};

// Scores a texture against a photo. The filters are the two slopes and the Laplacian of the image after
// Gaussian blurs of 1, 2, 4 and 8 pixels: twelve, or fewer for images of at most 64 pixels, since a blur
// counts only where it is an eighth of both sides. Borders without a whole filter are left out. Both images
// have sides above 8 pixels. The photo must not be constant.
TextureScore texture_score(const GreyImage& texture, const GreyImage& photo);

}  // namespace astrolith
