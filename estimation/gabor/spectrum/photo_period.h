// Finds the period of a photo that repeats itself, such as a tiled texture.
#pragma once

#include <vector>

#include "estimation/gabor/image/grey_image.h"
#include "numerics/progress.h"

namespace astrolith {

// The least periods in pixels; 0 along an axis where the photo does not repeat itself.
struct PhotoPeriod {
  int x = 0, y = 0;
  bool found() const { return x > 0 || y > 0; }
};

// Along an axis a photo of n pixels has the period p <= n / 2 if pixels at all multiples of p, up to 3 n / 4,
// are as good as alike, and others are not. Pixels are alike if the mean square of their differences is at
// most a fiftieth of the largest at lesser distances, which is more than what JPEG and rounding add, and
// about that of neighbouring pixels; an eighth of it where no second multiple is compared, as two hills of
// nearly one form are no tiles. A photo that does not change along an axis has no period there. All planes
// have one size. Throws WorkError when progress asks to stop.
PhotoPeriod find_period(const std::vector<GreyImage>& planes, const Progress& progress = {});

// A part of the planes that holds one period, or as many as make `least` pixels. It begins where its border
// is calm. Along an axis without a period it is the whole.
std::vector<GreyImage> one_period(std::vector<GreyImage> planes, const PhotoPeriod& period, int least);

}  // namespace astrolith
