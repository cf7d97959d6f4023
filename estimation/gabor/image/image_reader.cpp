#include "estimation/gabor/image/image_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "estimation/gabor/image/missing_ground.h"
#include "estimation/gabor/image/raster_file_internal.h"
#include "numerics/errors.h"

namespace astrolith {
namespace {

void require_fitting(double width, double height, const std::filesystem::path& file) {
  const double pixels = width * height;
  if (pixels <= kLargestImagePixels) return;
  throw InputError(
      fmt::format("{}: {} x {} pixels would take {:.0f} GB; cut out or scale down to at most "
                  "{:.0f} million pixels, such as 8192 x 8192",
                  file.string(), width, height, 18.0 * pixels / 1e9, kLargestImagePixels / 1e6));
}

// A larger value is a mark for no data that the file does not name, or its unit is too small.
constexpr double kLargestValue = 1e9;

void require_usable(const GreyImage& plane, const RasterFile& raster, const std::string& name) {
  for (std::size_t i = 0; i < plane.values.size(); ++i) {
    const double value = plane.values[i];
    if (!(std::abs(value) > kLargestValue)) continue;  // true for NaN
    const auto width = static_cast<std::size_t>(plane.width);
    throw InputError(
        fmt::format("{}: pixel ({}, {}): the value {} is beyond {:g}; name it as no data (gdal_translate "
                    "-a_nodata {}) or rescale the image",
                    name, i % width, i / width, value, kLargestValue, raster.to_stored(value)));
  }
}

// The largest share of missing pixels.
constexpr double kMostMissing = 0.5;

void require_known(const GreyImage& plane, const std::string& name) {
  const auto count =
      std::count_if(plane.values.begin(), plane.values.end(), [](double v) { return std::isnan(v); });
  const double share = static_cast<double>(count) / static_cast<double>(plane.values.size());
  if (share <= kMostMissing) return;
  throw InputError(fmt::format("{}: {:.0f} % of the pixels have no value; cut out a part with fewer gaps",
                               name, 100.0 * share));
}

// The two least and the two largest values that differ.
struct Extremes {
  double lowest = std::numeric_limits<double>::infinity(), above = lowest, below = -lowest, highest = -lowest;
};

Extremes find_extremes(const GreyImage& plane) {
  Extremes e;
  for (const double v : plane.values) {
    if (v < e.lowest)
      e.above = std::exchange(e.lowest, v);
    else if (v > e.lowest)
      e.above = std::min(e.above, v);
    if (v > e.highest)
      e.below = std::exchange(e.highest, v);
    else if (v < e.highest)
      e.below = std::max(e.below, v);
  }
  return e;
}

// Usual marks for no data that a file may store without naming them. One is taken for missing if it is the
// lowest or, of heights, the largest value by more than all other values differ.
// Where the file names its gaps, such a value counts, and is only said.
std::optional<std::string> unmark(GreyImage& plane, const RasterFile& raster, bool& said_counts) {
  const auto [lowest, above, below, highest] = find_extremes(plane);
  constexpr double kMarks[] = {0.0, 999.0, 9999.0, 32767.0, 32768.0, 65535.0, 99999.0};
  constexpr double kRounded = 1e-6;  // of floats
  const bool heights = raster.scale() && raster.scale()->heights;
  const auto unmarked = [&](double value, double gap, double others,
                            const char* where) -> std::optional<std::string> {
    if (!(gap > others) || !(others > 0.0)) return {};
    for (const double mark : kMarks) {
      const double stored = std::copysign(mark, raster.to_stored(value));
      if (std::abs(raster.to_value(stored) - value) > kRounded * std::abs(value)) continue;
      // Black and saturated pixels have brightness.
      if (!heights && !(stored < 0.0)) continue;
      if (raster.names_gaps()) {
        // The ground of a cut-out may be a floor of one value.
        if (said_counts) return {};
        said_counts = true;
        return fmt::format("{:g} lies far {} all other values and counts, since the file names other gaps",
                           stored, where);
      }
      std::replace(plane.values.begin(), plane.values.end(), value, std::numeric_limits<double>::quiet_NaN());
      return fmt::format(
          "{:g} lies far {} all other values and is taken for no data, though the file names none", stored,
          where);
    }
    return {};
  };
  std::optional<std::string> said = unmarked(lowest, above - lowest, highest - above, "below");
  return said ? said : unmarked(highest, highest - below, below - lowest, "above");
}

// A pixel without one of its colours has none of them.
void join_missing(std::vector<GreyImage>& planes) {
  for (std::size_t i = 0; planes.size() > 1 && i < planes.front().values.size(); ++i) {
    const auto is_missing = [i](const GreyImage& plane) { return std::isnan(plane.values[i]); };
    if (std::none_of(planes.begin(), planes.end(), is_missing)) continue;
    for (GreyImage& plane : planes) plane.values[i] = std::numeric_limits<double>::quiet_NaN();
  }
}

// The image as an EXIF orientation of 1 .. 8 turns it upright: those above 4 exchange rows and columns, and
// then some mirror the columns or the rows.
GreyImage upright(GreyImage image, int orientation) {
  if (orientation < 2 || orientation > 8) return image;
  const bool turned = orientation > 4;
  const bool mirrored = orientation == 2 || orientation == 3 || orientation == 6 || orientation == 7;
  const bool flipped = orientation == 3 || orientation == 4 || orientation == 7 || orientation == 8;
  GreyImage result{turned ? image.height : image.width, turned ? image.width : image.height, {}};
  result.values.reserve(image.values.size());
  for (int y = 0; y < result.height; ++y) {
    for (int x = 0; x < result.width; ++x) {
      const int u = mirrored ? result.width - 1 - x : x, v = flipped ? result.height - 1 - y : y;
      result.values.push_back(turned ? image.at(v, u) : image.at(u, v));
    }
  }
  return result;
}

// Collects rows of grey or colours into one plane or three.
TakeRow into(std::vector<GreyImage>& planes) {
  return [&planes](std::span<const double> row, int channels) {
    const auto count = static_cast<std::size_t>(channels);
    for (std::size_t i = 0; i < row.size(); i += count) {
      if (planes.size() == 1 && channels == 3) {
        planes[0].values.push_back(0.0722 * row[i + 2] + 0.7152 * row[i + 1] + 0.2126 * row[i]);
      } else {
        for (std::size_t k = 0; k < planes.size(); ++k)
          planes[k].values.push_back(row[i + (channels == 3 ? k : 0)]);
      }
    }
    for (GreyImage& plane : planes) {
      plane.width = static_cast<int>(row.size() / count);
      ++plane.height;
    }
  };
}

ImageFile empty_planes(std::size_t count, double pixels) {
  ImageFile result;
  result.planes.resize(count);
  for (GreyImage& plane : result.planes) plane.values.reserve(static_cast<std::size_t>(pixels));
  return result;
}

// Heights on the ground count from their mean: a radius of 1.7e6 m leaves few digits for a relief.
void take_mean_away(GreyImage& heights) {
  const double mean = known_mean(heights);
  for (double& v : heights.values) v -= mean;
}

}  // namespace

ImageSize read_image_size(const std::filesystem::path& file, const ImageWords& words) {
  const RasterFile raster(file, words);
  require_fitting(raster.width(), raster.height(), file);
  return {raster.width(), raster.height()};
}

void complete_planes(std::vector<GreyImage>& planes, const std::string& name, const Progress& progress) {
  join_missing(planes);
  for (GreyImage& plane : planes) {
    require_known(plane, name);
    fill_missing(plane, {}, progress);
  }
}

ImageFile read_image(const std::filesystem::path& file, bool colors, const Progress& progress,
                     const ImageWords& words) {
  RasterFile raster(file, words);
  require_fitting(raster.width(), raster.height(), file);
  ImageFile result = empty_planes(colors ? 3 : 1, static_cast<double>(raster.width()) * raster.height());
  raster.read(into(result.planes), progress);
  result.remarks = raster.remarks();
  result.scale = raster.scale();
  for (GreyImage& plane : result.planes) {
    plane = upright(std::move(plane), raster.orientation());
    // One mark hides another.
    bool said_counts = false;
    while (const auto mark = unmark(plane, raster, said_counts)) {
      if (&plane == &result.planes.front()) result.remarks.push_back(*mark);
    }
    require_usable(plane, raster, file.string());
  }
  complete_planes(result.planes, file.string(), progress);
  const bool heights = result.scale && result.scale->heights;
  const bool on_ground = heights && (result.scale->pixel_width > 0.0 || !words.height_unit.empty());
  for (GreyImage& plane : result.planes) {
    if (on_ground) take_mean_away(plane);
  }
  return result;
}

}  // namespace astrolith
