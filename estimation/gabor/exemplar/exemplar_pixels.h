// The pixels of an exemplar layer, from a grey photo or from red, green and blue.
#pragma once

#include <string>
#include <vector>

#include "estimation/gabor/image/grey_image.h"
#include "recipe/recipe.h"

namespace astrolith {

// Sides of the photos that become an exemplar, in pixels.
inline constexpr int kLeastTextureSide = 32, kMostTextureSide = 4096;

// Throws InputError for sides outside kLeastTextureSide to kMostTextureSide, and for a photo of one grey
// value. `name` is the photo's in messages.
void require_exemplar(const GreyImage& photo, const std::string& name);
// Throws InputError for planes with values beyond -1 to 2, which are no colours.
void require_colors(const std::vector<GreyImage>& planes, const std::string& name);

// The image in 16 bits: the darkest pixel becomes 0, the brightest 65535.
ExemplarImage in_16_bits(const GreyImage& image);
// Red, green and blue in 16 bits of full scale, cut off at 0 and 1, with their luma.
ExemplarImage colors_in_16_bits(const std::vector<GreyImage>& planes);

// The luma of three planes: 0.2126 R + 0.7152 G + 0.0722 B.
GreyImage luma_of(const std::vector<GreyImage>& planes);

}  // namespace astrolith
