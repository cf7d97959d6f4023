// How much memory a fit takes, said before it.
#pragma once

#include "estimation/gabor/image/image_reader.h"
#include "estimation/gabor/photo_fit.h"

namespace astrolith {

// Predicted peak of a program that fits an image of this size, bytes: what the image takes while it is read
// and kept, and what the pursuit takes for each point of the spectrum's grid. Measured within a fifth for
// 8-bit images; deeper ones take up to 20 bytes a pixel more while they are read.
double predicted_fit_bytes(const ImageSize& image, const PhotoFitOptions& options, bool report);

}  // namespace astrolith
