// Images of pixels that are wider than high, or higher than wide, on a grid of square pixels.
#pragma once

#include "estimation/gabor/image/grey_image.h"

namespace astrolith {

// The image on square pixels with the longer of the two sides. The values between pixels are those of a
// Lanczos kernel of the width of a new pixel, which leaves out the waves that the new grid cannot hold. A
// pixel is missing where most of the weight of its kernel lies on missing ones. The sides are above 0.
GreyImage with_square_pixels(const GreyImage& image, double pixel_width, double pixel_height);

}  // namespace astrolith
