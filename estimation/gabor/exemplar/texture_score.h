// How near a texture is to a photo, pixel positions aside.
#pragma once

#include <vector>

#include "estimation/gabor/image/grey_image.h"

namespace astrolith {

// Wasserstein-1 distances between distributions, over the standard deviation of the photo's; 0 for equal
// distributions.
struct TextureScore {
  double values = 0.0;   // of the grey values
  double filters = 0.0;  // of filter responses, the mean over all filters

  double sum() const { return values + filters; }
};

// The distributions by which textures are compared: of grey values, and of filter responses. The filters are
// the two slopes and the Laplacian of the image after Gaussian blurs of 1, 2, 4 and 8 pixels: twelve, or
// fewer for images of at most 64 pixels, since a blur counts only where it is an eighth of both sides.
// Borders without a whole filter are left out.
class TextureDistributions {
 public:
  // Sides are above 8 pixels. `side`, at most the image's shorter one, says which blurs count.
  TextureDistributions(const GreyImage& image, int side);
  // Scores this texture against a photo that is not constant, by the filters to which it responds. Both were
  // made with one side.
  TextureScore score_against(const TextureDistributions& photo) const;

 private:
  struct Distribution {
    std::vector<double> quantiles;
    double deviation;
  };
  static Distribution sorted_distribution(std::vector<double> values);
  std::vector<Distribution> distributions_;  // of the grey values, then of each filter
};

// Scores a texture against a photo.
TextureScore texture_score(const GreyImage& texture, const GreyImage& photo);

}  // namespace astrolith
