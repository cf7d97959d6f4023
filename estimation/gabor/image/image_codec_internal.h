// Reads the header of an image file, and decodes the image: by OpenCV, and TIFF files of 16-bit floats by
// libtiff.
#pragma once

#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>
#include <string>

namespace astrolith {

struct ImageHeader {
  std::string format;  // "PNG", "JPEG" or "TIFF"
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  bool more_pages = false;   // further pages (TIFF) or frames (animated PNG)
  bool has_alpha = false;    // PNG and TIFF
  bool half_floats = false;  // 16-bit floats (TIFF)
};

// Throws InputError for files that cannot be read, and for files that are not PNG, JPEG or TIFF.
ImageHeader read_image_header(const std::filesystem::path& file);

// An image of 1 or 3 channels (blue, green, red), 8 or 16 bits unsigned or floats. Palettes are expanded, and
// the image is turned upright as the file's EXIF orientation asks. Throws InputError for files that cannot be
// decoded.
cv::Mat decode_image(const std::filesystem::path& file, const ImageHeader& header);

// The share of pixels that are not fully opaque, in [0, 1].
double share_not_opaque(const std::filesystem::path& file, const ImageHeader& header);

}  // namespace astrolith
