// What a TIFF's tags say that GDAL keeps to itself.
#pragma once

#include <filesystem>

namespace astrolith {

struct TiffTags {
  int orientation = 1;  // as EXIF counts it, 1 .. 8: where the first row and column of the picture stand
  bool premultiplied = false;  // alpha is associated: colours are stored multiplied by it
};

// The tags of the first picture; those of a plain one for a file that is no TIFF. Throws InputError for a
// TIFF that is damaged, and for a camera's raw file, whose first picture is a thumbnail.
TiffTags read_tiff_tags(const std::filesystem::path& file);

}  // namespace astrolith
