// What an image file says about itself, read without decoding it.
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

// Throws InputError for files that cannot be read or are none of the three.
ImageHeader read_image_header(const std::filesystem::path& file);

}  // namespace astrolith
