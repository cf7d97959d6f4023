// Reads photos and rasters by GDAL: PNG, JPEG, WebP, TIFF and GeoTIFF, cubes of ISIS, images of the PDS and
// others. Its helpers read the unit of heights, the size of pixels on the ground, and tags of TIFF that GDAL
// keeps to itself.
#pragma once

#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "estimation/gabor/image/image_reader.h"
#include "numerics/progress.h"

class GDALDataset;
class GDALRasterBand;

namespace astrolith {

// The steps of a pixel along a row and along a column, in metres on the ground.
struct GroundStep {
  double east = 0.0, north = 0.0;
  double length() const { return std::sqrt(east * east + north * north); }
};
struct GroundSteps {
  GroundStep column, row;
  std::string source;                                  // StatedScale::pixel_source
  bool like_degrees = false, perhaps_degrees = false;  // as StatedScale
  bool unknown = false;                                // as StatedScale
  bool west = false, south = false;  // columns run to the west; rows run to the north, from the south
  std::string plane_unit;            // of the frame's plane, where it is not metres
};

// By the raster's transform and its spatial reference: a grid in degrees by the radius of its body, a
// projected one by its unit of length, or on the ground in the middle of the map where the projection
// stretches it. Unknown where PROJ lacks its data or cannot transform the middle. None where the file states
// no size of pixels.
std::optional<GroundSteps> ground_steps(GDALDataset& raster);

struct TiffTags {
  int orientation = 1;  // as EXIF counts it, 1 .. 8: where the first row and column of the picture stand
  bool premultiplied = false;  // alpha is associated: colours are stored multiplied by it
};

// The tags of the first picture; those of a plain one for a file that is no TIFF. Throws InputError for a
// TIFF that is damaged, and for a camera's raw file, whose first picture is a thumbnail.
TiffTags read_tiff_tags(const std::filesystem::path& file);

// The unit of the heights of a compound frame, as unit_metres() takes it; empty where the frame states none.
std::string vertical_unit(GDALDataset& raster);

// What the label of a PDS3 image states for a keyword, without quotes; empty where it does not. GDAL keeps
// some keywords to itself.
std::string value_in_label(const std::filesystem::path& file, std::string_view keyword);

// Takes a row of pixels of 1 channel, or of 3: red, green and blue.
using TakeRow = std::function<void(std::span<const double> row, int channels)>;

class RasterFile {
 public:
  // Opens the file and decodes no pixel. Throws InputError for files of another kind and for damaged ones,
  // for complex pixels, and for bands that are neither one height map or picture nor red, green and blue.
  explicit RasterFile(const std::filesystem::path& file, const ImageWords& words = {});
  ~RasterFile();
  RasterFile(const RasterFile&) = delete;
  RasterFile& operator=(const RasterFile&) = delete;

  int width() const;  // as stored, before the picture is turned upright
  int height() const;
  // The orientation as EXIF counts it, 1 .. 8, or as the raster stands on the ground: north above and east to
  // the right.
  int orientation() const { return orientation_; }
  const std::optional<StatedScale>& scale() const { return scale_; }
  // What was not used of the file. The share of transparent pixels is known after read().
  std::vector<std::string> remarks() const;

  // Gives the rows from the top as stored. Heights are metres where StatedScale says so. Floats, signed
  // integers and values with a scale of their own are as the file states them, and of others the full scale
  // is 1. A missing pixel is a NaN: one that the file calls no data or masks, one that is not finite or
  // beyond 1e30, and one whose colours an alpha of 0 has erased. Throws InputError for damaged files, and
  // WorkError where progress asks to stop.
  void read(const TakeRow& take, const Progress& progress = {});

  // Whether the file says which pixels have no value, so that nobody need guess.
  bool names_gaps() const;

  // What read() makes of a stored number of one band, and the stored number of such a value.
  double to_value(double stored) const;
  double to_stored(double value) const;

 private:
  struct Bands;
  void find_bands();
  void require_known_floats() const;
  void read_label(GDALRasterBand& first);
  void read_fits(GDALRasterBand& first);
  void find_scale(const std::string& height_unit);
  void turn_to_north(const GroundSteps& steps);
  [[noreturn]] void fail(const std::string& what) const;

  std::string name_;
  std::unique_ptr<GDALDataset> dataset_;
  std::unique_ptr<Bands> bands_;
  int orientation_ = 1;
  bool animated_ = false;
  std::optional<StatedScale> scale_;
};

}  // namespace astrolith
