// Photos and height maps from files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "estimation/gabor/grey_image.h"

namespace astrolith {

struct ImageFile {
  GreyImage image;
  std::vector<std::string> remarks;  // what of the file was not used: "alpha channel ignored"
};

// Largest image that is decoded: 2^26 pixels (8192 x 8192), which takes about 1 GB while reading.
inline constexpr double kLargestImagePixels = 67108864.0;

// Reads PNG, JPEG or TIFF, told by their first bytes, with 8 or 16 bits or 32-bit floats a channel; palettes
// are expanded. Integers are scaled so that full scale is 1, floats kept. Colours become the luma 0.2126 R +
// 0.7152 G + 0.0722 B of the values as stored. The size is checked before anything is decoded. Throws
// InputError for a file that is missing, of another kind, damaged, too large, or holds a value that is not
// finite.
ImageFile read_grey_image(const std::filesystem::path& file);

}  // namespace astrolith
