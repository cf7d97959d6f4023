// Photos and height maps from files, and what the file of a height map, or of a picture from above, states
// about its pixels.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "estimation/gabor/image/grey_image.h"
#include "numerics/progress.h"

namespace astrolith {

struct StatedScale {
  // The sides of a pixel on the ground in metres; 0 where the file states none.
  double pixel_width = 0.0, pixel_height = 0.0;
  bool sheared = false;       // the sides are not perpendicular
  bool like_degrees = false;  // no unit is stated, and the whole map would be most of a globe in degrees
  // No unit is stated, and the map would lie on a globe in degrees, but also in small pixels of metres.
  bool perhaps_degrees = false;
  bool unknown = false;       // PROJ cannot tell the pixels on the ground; the sides are not to be trusted
  std::string pixel_source;   // how metres were found, such as "no unit is stated"; empty for plain metres
  bool heights = false;       // the values are heights in metres, and not brightness
  std::string height_source;  // as pixel_source, of the heights
};

struct ImageFile {
  std::vector<GreyImage> planes;     // red, green and blue, of the same size, or grey alone
  std::vector<std::string> remarks;  // the parts of the file that were not used, such as "alpha ignored"
  std::optional<StatedScale> scale = {};
};

struct ImageSize {
  int width = 0;
  int height = 0;
};

// What a caller says of a file that does not say it.
struct ImageWords {
  std::string height_unit =
      {};  // the values are heights in this unit (unit_metres()); empty: as the file says
  std::optional<ImageSize> raw_size = {};  // the file is raw numbers of so many rows and columns
};

// The metres of a unit of length by its name, in any case; 0 for another unit. Words behind it that say from
// where heights count are passed over: "metres above the ellipsoid", "m (MSL)".
double unit_metres(const std::string& unit);

// The largest number of pixels of an image that is decoded: 2^26 (8192 x 8192). Reading such an image takes
// about 1.2 GB in grey and 2.5 GB in colours.
inline constexpr double kLargestImagePixels = 67108864.0;

// The functions below read photos (PNG, JPEG, WebP) and rasters (TIFF, GeoTIFF and others: docs/pictures.md),
// which they tell by their first bytes. Palettes are expanded and the EXIF orientation of a JPEG or TIFF is
// honoured. Alpha is ignored: the stored colours of transparent pixels count, unless the file says that alpha
// is multiplied into them, which is undone. If a file has several pages or frames, the first is read, but
// that of a WebP. Integers are scaled so that full scale is 1. Floats, signed integers and values with a
// scale or a unit of their own are as the file states them, heights in metres; heights with a size of pixels
// are heights above their mean. Pixels without a value are missing (grey_image.h). The size is checked before
// anything is decoded. The functions throw InputError for a file that is missing, of another kind, damaged or
// too large, for values beyond 1e9, and where fewer than half of the pixels have a value.

// Width and height as stored, in pixels, from the header alone.
ImageSize read_image_size(const std::filesystem::path& file, const ImageWords& words = {});

// Reads three planes of colours, equal ones of a grey file, or a grey plane: colours become the luma
// 0.2126 R + 0.7152 G + 0.0722 B of the stored values. The values of photos are gamma-encoded, and stay so.
// Throws WorkError where progress asks to stop.
ImageFile read_image(const std::filesystem::path& file, bool colors, const Progress& progress = {},
                     const ImageWords& words = {});

// Marks pixels that are NaN in a plane as missing in all planes, and continues the others into them. Throws
// InputError where fewer than half of the pixels have a value.
void complete_planes(std::vector<GreyImage>& planes, const std::string& name, const Progress& progress = {});

}  // namespace astrolith
