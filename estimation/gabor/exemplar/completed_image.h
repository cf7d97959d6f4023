// Stands noise in for missing ground, so that a spectrum can be estimated from what is known.
#pragma once

#include <cstdint>

#include "estimation/gabor/image/grey_image.h"
#include "numerics/progress.h"

namespace astrolith {

// The image with new values where pixels are missing: a conditional simulation of a Gaussian texture with the
// spectrum of the image (Journel and Huijbregts, Mining Geostatistics, 1978, VII.A). To the values f that
// continue the known pixels smoothly it adds s - h, where s is noise of random phases with the spectrum and h
// continues s from the known pixels as f continues the image. Known pixels stay, and there is no step at the
// border of a gap. The first spectrum is that of f, which lacks power, and each next one that of the last
// result. Of several last results that is taken whose spectrum is nearest to the mean of theirs. An image
// without missing pixels is returned as it is. Throws WorkError when `progress` asks to stop.
GreyImage completed(GreyImage image, std::uint64_t seed, const Progress& progress = {});

}  // namespace astrolith
