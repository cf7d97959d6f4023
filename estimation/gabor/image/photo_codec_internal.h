// Reads the header of a photo, and decodes the photo by OpenCV.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <string>

namespace astrolith {

struct PhotoHeader {
  std::string format;  // "PNG", "JPEG" or "WebP"
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  bool more_frames = false;  // of an animated PNG
  bool has_alpha = false;    // PNG and WebP
};

// No header where the file's first bytes are not those of a PNG, JPEG or WebP. Throws InputError for files
// that cannot be read.
std::optional<PhotoHeader> read_photo_header(const std::filesystem::path& file);

// Takes a row of pixels of 1 channel, or of 3: red, green and blue.
using TakeRow = std::function<void(std::span<const double> row, int channels)>;

// Gives the rows from the top, with a full scale of 1. Palettes are expanded, and the photo is turned upright
// as its EXIF orientation asks. Throws InputError for files that cannot be decoded.
void read_photo(const std::filesystem::path& file, const TakeRow& take);

// The share of pixels that are not fully opaque, in [0, 1].
double share_not_opaque(const std::filesystem::path& file, const PhotoHeader& header);

}  // namespace astrolith
