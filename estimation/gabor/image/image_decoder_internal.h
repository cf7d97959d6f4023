// The pixels of an image file, by OpenCV and, for what it does not know, libtiff.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>

#include "estimation/gabor/image/image_header_internal.h"

namespace astrolith {

// 1 or 3 channels (blue, green, red) of 8 or 16 bits unsigned or of floats, palettes expanded, upright as the
// file's EXIF orientation asks. Throws InputError for what cannot be decoded.
cv::Mat decode_image(const std::filesystem::path& file, const ImageHeader& header);

// Share of pixels that the alpha channel calls not quite opaque.
double share_not_opaque(const std::filesystem::path& file, const ImageHeader& header);

}  // namespace astrolith
