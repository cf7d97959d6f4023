// Reads the header of an image file without decoding the image.
#pragma once

#include <cstdint>
#include <filesystem>
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

}  // namespace astrolith
