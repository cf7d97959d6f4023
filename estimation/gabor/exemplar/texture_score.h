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
  // OrientedSlopes::difference_from(), where it was asked for. A mirror image has the same values and
  // filters.
  double direction = 0.0;

  double sum() const { return values + filters + direction; }
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

  struct Distribution {
    std::vector<double> quantiles;
    double deviation;
  };

 private:
  std::vector<Distribution> distributions_;  // of the grey values, then of each filter
};

// What tells an image from its mirror image, after each of the same blurs. At 45 degrees a texture has slopes
// along x and y that are correlated, and of its diagonals one is rougher.
class OrientedSlopes {
 public:
  // As TextureDistributions.
  OrientedSlopes(const GreyImage& image, int side);
  // The distances of the slopes along both diagonals, and the difference of the correlation of the slopes
  // along x and y, each a mean over the blurs. Both were made with one side.
  double difference_from(const OrientedSlopes& photo) const;
  // The correlation of the slopes along x and y after the smallest blur; 0 where there is no slope.
  double correlation() const { return blurs_.empty() ? 0.0 : blurs_.front().correlation; }

 private:
  struct Blur {
    double correlation;
    TextureDistributions::Distribution falling, rising;  // of the slopes along both diagonals
  };
  std::vector<Blur> blurs_;
};

// Scores a texture against a photo, but for its direction.
TextureScore texture_score(const GreyImage& texture, const GreyImage& photo);

}  // namespace astrolith
