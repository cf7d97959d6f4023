// Predicts how much memory a fit takes.
#pragma once

#include "estimation/gabor/image/image_reader.h"
#include "estimation/gabor/photo_fit.h"

namespace astrolith {

// The predicted peak memory, in bytes, of a program that fits an image of this size. It is the memory of the
// image while it is read and kept, and the memory of the pursuit for each point of the spectrum's grid. For
// 8-bit images the prediction was within a fifth of the measured peak. Deeper images take up to 20 bytes per
// pixel more while they are read. `report`: pictures of the fit are drawn too. `layer_image`: the layer may
// have an image, of the models phase and exemplar.
double predicted_fit_bytes(const ImageSize& image, const PhotoFitOptions& options, bool report,
                           bool layer_image);

}  // namespace astrolith
