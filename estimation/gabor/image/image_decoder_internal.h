// Decodes image files by OpenCV, and TIFF files of 16-bit floats by libtiff.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>

#include "estimation/gabor/image/image_header_internal.h"

namespace astrolith {

// An image of 1 or 3 channels (blue, green, red), 8 or 16 bits unsigned or floats. Palettes are expanded, and
// the image is turned upright as the file's EXIF orientation asks. Throws InputError for files that cannot be
// decoded.
cv::Mat decode_image(const std::filesystem::path& file, const ImageHeader& header);

// The share of pixels that are not fully opaque, in [0, 1].
double share_not_opaque(const std::filesystem::path& file, const ImageHeader& header);

}  // namespace astrolith
