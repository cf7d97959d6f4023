// Random-phase noise with the whole spectrum of a photo, as the image of an exemplar layer. The
// noise also stands in for missing ground, so that a spectrum can be estimated from what is known.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "estimation/gabor/image/grey_image.h"
#include "estimation/gabor/spectrum/power_spectrum.h"
#include "numerics/progress.h"
#include "recipe/recipe.h"

namespace astrolith {

// The image with new values where pixels are missing: a conditional simulation of a Gaussian texture with the
// spectrum of the image (Journel and Huijbregts, Mining Geostatistics, 1978, VII.A). To the values f that
// continue the known pixels smoothly it adds s - h, where s is noise of random phases with the spectrum and h
// continues s from the known pixels as f continues the image. Known pixels stay, and there is no step at the
// border of a gap. The first spectrum is that of f, which lacks power, and each next one that of the last
// result. Of several last results that is taken whose spectrum is nearest to the mean of theirs. An image
// without missing pixels is returned as it is. Throws WorkError when `progress` asks to stop.
GreyImage completed(GreyImage image, std::uint64_t seed, const Progress& progress = {});

// A periodic Gaussian texture with the power of every frequency of a spectrum and random phases (Galerne,
// Gousseau and Morel, Random phase textures, IEEE TIP 2011), mean 0. Its variance is that of the spectrum
// exactly. Throws WorkError when progress asks to stop.
GreyImage random_phase_image(const PowerSpectrum& spectrum, std::uint32_t seed,
                             const Progress& progress = {});

// The longest side of the image of random phases that a side of a photo may have, in pixels.
int longest_phase_side(int side);

// An exemplar layer whose image has the spectrum of the photo, whatever its kind, and random phases. The
// photo is one plane of grey, or red, green and blue, whose principal axes become independent textures. Along
// an axis where the photo does not repeat the image is four times as long, at most 1024 pixels or the photo's
// own length: the longer it is, the less does blending change its spectrum. Lengths are pixels.
// height_rms is the deviation of the texture or of its luma: that of the photo but for light from one side
// and other features wider than it. Throws as require_exemplar() and require_colors() do,
// and WorkError when progress asks to stop.
ExemplarLayer phase_exemplar(const std::vector<GreyImage>& planes, const std::string& name,
                             std::uint64_t seed, const Progress& progress = {});

}  // namespace astrolith
