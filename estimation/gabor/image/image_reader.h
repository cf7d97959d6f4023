// Photos and height maps from files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "estimation/gabor/image/grey_image.h"

namespace astrolith {

struct ImageFile {
  GreyImage image;
  std::vector<std::string> remarks;  // what of the file was not used: "alpha ignored"
};

struct ColorImageFile {
  std::vector<GreyImage> planes;  // red, green and blue, of the same size
  std::vector<std::string> remarks;
};

struct ImageSize {
  int width = 0;
  int height = 0;
};

// Largest image that is decoded: 2^26 pixels (8192 x 8192), which takes about 1.2 GB while reading grey and
// 2.5 GB in colours.
inline constexpr double kLargestImagePixels = 67108864.0;

// Read PNG, JPEG or TIFF, told by their first bytes, with 8 or 16 bits or 16-, 32- or 64-bit floats a
// channel; palettes are expanded, the EXIF orientation is honoured, alpha is ignored (the colours stored
// under it count), of several pages or frames the first is taken. Integers are scaled so that full scale is
// 1, floats kept. The size is checked before anything is decoded. Throw InputError for a file that is
// missing, of another kind, damaged, too large, or holds a value that is not finite.

// Width and height as stored, from the header alone.
ImageSize read_image_size(const std::filesystem::path& file);

// Colours become the luma 0.2126 R + 0.7152 G + 0.0722 B of the values as stored, which for photos
// are gamma-encoded; nothing is made linear.
ImageFile read_grey_image(const std::filesystem::path& file);

// The planes are equal where the file is grey.
ColorImageFile read_color_image(const std::filesystem::path& file);

}  // namespace astrolith
