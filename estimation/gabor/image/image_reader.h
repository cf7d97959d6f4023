// Photos and height maps from files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "estimation/gabor/image/grey_image.h"

namespace astrolith {

struct ImageFile {
  GreyImage image;
  std::vector<std::string> remarks;  // the parts of the file that were not used, such as "alpha ignored"
};

struct ColorImageFile {
  std::vector<GreyImage> planes;  // red, green and blue, of the same size, or grey alone
  std::vector<std::string> remarks;
};

struct ImageSize {
  int width = 0;
  int height = 0;
};

// The largest number of pixels of an image that is decoded: 2^26 (8192 x 8192). Reading such an image takes
// about 1.2 GB in grey and 2.5 GB in colours.
inline constexpr double kLargestImagePixels = 67108864.0;

// The functions below read PNG, JPEG and TIFF, which they tell by their first bytes. A channel has 8 or 16
// bits, or is a 16-, 32- or 64-bit float. Palettes are expanded and the EXIF orientation is honoured. Alpha
// is ignored: the stored colours of transparent pixels count. If a file has several pages or frames, the
// first is read. Integers are scaled so that full scale is 1; floats keep their values. The size is checked
// before anything is decoded. The functions throw InputError for a file that is missing, of another kind,
// damaged or too large, and for values that are not finite or beyond 1e5.

// Width and height as stored, in pixels, from the header alone.
ImageSize read_image_size(const std::filesystem::path& file);

// Reads a grey image. Colours become the luma 0.2126 R + 0.7152 G + 0.0722 B of the stored values. The values
// of photos are gamma-encoded, and stay so.
ImageFile read_grey_image(const std::filesystem::path& file);

// Reads a colour image. If the file is grey, the three planes are equal.
ColorImageFile read_color_image(const std::filesystem::path& file);

// Reads a colour image, or a grey one as the only plane.
ColorImageFile read_image(const std::filesystem::path& file, bool colors);

}  // namespace astrolith
