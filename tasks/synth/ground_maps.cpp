#include "tasks/synth/ground_maps.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "geometry/surface/height_map.h"
#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "numerics/length_unit.h"
#include "numerics/vec3_json.h"
#include "synthesis/field/feature_list.h"
#include "synthesis/picture/image_file.h"
#include "tasks/job/output_names.h"
#include "tasks/job/words.h"

namespace astrolith {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kBands = 3;
const std::vector<std::string> kBandNames{"slope_deg", "roughness_m", "boulder_m"};

// Pixels on each side of the middle one of a footprint.
int half_footprint(double footprint, double pixel) {
  return static_cast<int>(std::lround(0.5 * (footprint / pixel - 1.0)));
}

// Effective gravity on a lattice over the map, from which that of a pixel is interpolated: it varies with the
// body, not with the ground.
class VerticalLattice {
 public:
  VerticalLattice(const HeightMap& map, const Vec3d& center, double metres, const SurfaceGravity& gravity)
      : side_(map.side) {
    std::vector<Vec3d> places;
    for (int j = 0; j < kNodes; ++j) {
      for (int i = 0; i < kNodes; ++i) {
        const double x = (side_ - 1.0) * i / (kNodes - 1), y = (side_ - 1.0) * j / (kNodes - 1);
        const float height = map.heights[static_cast<std::size_t>(std::lround(y)) * map.side +
                                         static_cast<std::size_t>(std::lround(x))];
        places.push_back(center + map.origin + (x + 0.5 - 0.5 * side_) * map.pixel * map.right +
                         (0.5 * side_ - y - 0.5) * map.pixel * map.ahead +
                         (std::isfinite(height) ? height / metres : 0.0) * map.up);
      }
    }
    for (const PointGravity& value : gravity.at(places)) effective_.push_back(value.effective);
  }

  Vec3d at(int column, int row) const {
    const double x = scaled(column), y = scaled(row);
    const int i = std::min(static_cast<int>(x), kNodes - 2), j = std::min(static_cast<int>(y), kNodes - 2);
    const double u = x - i, v = y - j;
    return (1.0 - v) * ((1.0 - u) * node(i, j) + u * node(i + 1, j)) +
           v * ((1.0 - u) * node(i, j + 1) + u * node(i + 1, j + 1));
  }

 private:
  static constexpr int kNodes = 33;
  double scaled(int pixel) const { return pixel * (kNodes - 1) / std::max(side_ - 1.0, 1.0); }
  const Vec3d& node(int i, int j) const { return effective_[static_cast<std::size_t>(j * kNodes + i)]; }

  double side_;
  std::vector<Vec3d> effective_;
};

double largest_axis(const PlacedBoulder& boulder) {
  return std::max({boulder.axes.x, boulder.axes.y, boulder.axes.z});
}

// Marks the third band where footprints reach boulders, seen from above. The largest boulder comes first, so
// that a pixel is marked once, and passed over from then on.
class BoulderMarks {
 public:
  BoulderMarks(const HeightMap& map, const Vec3d& center, double metres, double footprint,
               std::vector<float>& bands)
      : map_(map),
        center_(center),
        metres_(metres),
        half_(0.5 * footprint / map.pixel),
        bands_(bands),
        next_(static_cast<std::size_t>(map.side) * (static_cast<std::size_t>(map.side) + 1)) {
    for (std::size_t at = 0; at < next_.size(); ++at)
      next_[at] = static_cast<int>(at % (static_cast<std::size_t>(map.side) + 1));
  }

  void mark(const PlacedBoulder& boulder) {
    const double diameter = largest_axis(boulder), radius = 0.5 * diameter / map_.pixel;
    const Vec3d d = boulder.center - center_ - map_.origin;
    const double x = dot(d, map_.right) / map_.pixel + 0.5 * map_.side - 0.5,
                 y = 0.5 * map_.side - 0.5 - dot(d, map_.ahead) / map_.pixel;
    const double reach = radius + half_, last = map_.side - 1.0;
    for (int j = static_cast<int>(std::ceil(std::max(y - reach, 0.0))); j <= std::min(y + reach, last); ++j) {
      const double along = std::max(std::fabs(j - y) - half_, 0.0);
      const double width = half_ + std::sqrt(std::max(radius * radius - along * along, 0.0));
      const double first = std::ceil(std::clamp(x - width, 0.0, last + 1.0));
      for (int i = unmarked(j, static_cast<int>(first)); i <= std::min(x + width, last);
           i = unmarked(j, i + 1)) {
        float& band = bands_[kBands * (static_cast<std::size_t>(j) * static_cast<std::size_t>(map_.side) +
                                       static_cast<std::size_t>(i)) +
                             2];
        if (!std::isnan(band)) band = static_cast<float>(metres_ * diameter);
        next(j, i) = i + 1;
      }
    }
  }

 private:
  int& next(int row, int column) {
    return next_[static_cast<std::size_t>(row) * (static_cast<std::size_t>(map_.side) + 1) +
                 static_cast<std::size_t>(column)];
  }
  // The first pixel of the row, from this one on, that is not marked; the side of the map where all are.
  int unmarked(int row, int column) {
    while (next(row, column) != column) column = next(row, column) = next(row, next(row, column));
    return column;
  }

  const HeightMap& map_;
  Vec3d center_;
  double metres_, half_;  // half a footprint, pixels
  std::vector<float>& bands_;
  std::vector<int> next_;  // of each pixel, itself or one on the way to the next unmarked one
};

// Marks all boulders that the map resolves.
void mark_boulders(const std::vector<Feature>& landforms, double pixel, BoulderMarks marks) {
  std::vector<const PlacedBoulder*> boulders;
  for (const Feature& landform : landforms) {
    if (landform.boulder != nullptr && is_resolved(landform, pixel)) boulders.push_back(landform.boulder);
  }
  std::stable_sort(boulders.begin(), boulders.end(), [](const PlacedBoulder* a, const PlacedBoulder* b) {
    return largest_axis(*a) > largest_axis(*b);
  });
  for (const PlacedBoulder* boulder : boulders) marks.mark(*boulder);
}

Json largest_values(const std::vector<float>& bands) {
  Json largest;
  for (std::size_t k = 0; k < kBands; ++k) {
    float most = 0.0f;
    for (std::size_t i = k; i < bands.size(); i += kBands) most = std::fmax(most, bands[i]);
    largest[kBandNames[k]] = most;
  }
  return largest;
}

fs::path frame_file(const fs::path& file) { return fs::path(file).replace_extension(".json"); }

void check_map(const fs::path& file, const std::string& option, const MeshPart& part) {
  constexpr int kMostPixels = 16384;
  if (!part.region.is_patch) throw InputError(option + ": is of a patch; add --patch X Y Z SIDE");
  if (!part.region.plane)
    throw InputError(option +
                     ": the patch holds no surface that faces one direction; move it, or take a smaller one");
  if (part.recipe.length_unit == "px")
    throw InputError(option + ": a recipe in px has no size; state m or km in it");
  if (part.resolution > kMostPixels)
    throw InputError(option + ": has at most 16384 pixels along a side; lower --resolution");
  require_extension(file, {".tif"});
  require_writable(file);
}

// Where the pixels of a map lie in the body frame, and how many have no height.
Json frame_json(const HeightMap& map, const MeshPart& part) {
  const double metres = metres_per_unit(part.recipe.length_unit);
  std::int64_t without = 0;
  for (const float height : map.heights) without += std::isnan(height) ? 1 : 0;
  return {{"pixels", map.side},
          {"metres_per_pixel", metres * map.pixel},
          {"origin_m", to_json(metres * (part.recipe.origin + part.region.center + map.origin))},
          {"right", to_json(map.right)},
          {"ahead", to_json(map.ahead)},
          {"up", to_json(map.up)},
          {"body_frame", part.recipe.frame},
          {"pixel_center",
           "origin + (i + 1/2 - pixels/2) metres_per_pixel right + (pixels/2 - (j + 1/2)) "
           "metres_per_pixel ahead + height up; column i, row j from the top left"},
          {"pixels_without_data", without}};
}

std::string ascii_line(const Json& frame) {
  return frame.dump(-1, ' ', true, Json::error_handler_t::replace);
}

void write_hazard_map(Job& job, const MeshSinks& sinks, const HeightMap& map, const MeshPart& part,
                      const SurfaceGravity& gravity) {
  const double metres = metres_per_unit(part.recipe.length_unit);
  const int half = half_footprint(sinks.footprint, map.pixel);
  HeightMap in_metres = map;
  in_metres.pixel *= metres;
  const std::vector<FootprintPlane> planes = footprint_planes(in_metres, half);
  const VerticalLattice verticals(map, part.region.center, metres, gravity);
  std::vector<float> bands(kBands * planes.size());
  for (std::size_t at = 0; at < planes.size(); ++at) {
    const FootprintPlane& plane = planes[at];
    const auto side = static_cast<std::size_t>(map.side);
    const Vec3d normal =
        normalized(map.up - double{plane.along_right} * map.right - double{plane.along_ahead} * map.ahead);
    const bool known = std::isfinite(plane.rms);
    bands[kBands * at] =
        known ? static_cast<float>(slope_degrees(
                    normal, verticals.at(static_cast<int>(at % side), static_cast<int>(at / side))))
              : plane.rms;
    bands[kBands * at + 1] = plane.rms;
    bands[kBands * at + 2] = known ? 0.0f : plane.rms;
  }
  const std::vector<Feature> landforms = list_features(part.field, part.region.cube());
  mark_boulders(landforms, map.pixel, {map, part.region.center, metres, map.pixel * (2 * half + 1), bands});
  Json frame = frame_json(map, part);
  frame["footprint_m"] = metres * map.pixel * (2 * half + 1);
  frame["largest"] = largest_values(bands);
  write_geotiff(bands, map.side, map.side, metres * map.pixel, ascii_line(frame), sinks.hazard_map,
                kBandNames);
  job.summary["hazard_map"] = {{"footprint_m", frame["footprint_m"]}, {"largest", frame["largest"]}};
}

}  // namespace

std::vector<fs::path> height_map_files(const std::vector<std::string>& names) {
  std::vector<fs::path> files(names.begin(), names.end());
  for (const std::string& name : names) files.push_back(frame_file(name));
  return files;
}

void check_ground_maps(const MeshSinks& sinks, const MeshPart& part) {
  if (!sinks.height_map.empty()) {
    check_map(sinks.height_map, "--height-map", part);
    require_writable(frame_file(sinks.height_map));
  }
  if (sinks.hazard_map.empty()) return;
  check_map(sinks.hazard_map, "--hazard-map", part);
  if (!(sinks.footprint > 0.0)) {
    throw InputError(
        "--hazard-map: needs the side of the ground that a lander stands on; add --footprint L, in the "
        "recipe's unit");
  }
  const double size = part.region.size, pixel = size / part.resolution;
  if (sinks.footprint < 3.0 * pixel || sinks.footprint > 0.5 * size) {
    throw InputError(
        "--footprint: is less than 3 pixels or more than half the patch; change --resolution or the patch");
  }
}

void write_ground_maps(Job& job, const MeshSinks& sinks, const MeshPart& part, const TriangleMesh& mesh,
                       const SurfaceGravity* gravity) {
  if (!sinks.has_ground_maps()) return;
  const double metres = metres_per_unit(part.recipe.length_unit);
  const HeightMap map = height_map(mesh, *part.region.plane, part.region.size, part.resolution, metres);
  if (!sinks.height_map.empty()) {
    const Json frame = frame_json(map, part);
    write_geotiff(map.heights, map.side, map.side, metres * map.pixel, ascii_line(frame), sinks.height_map);
    write_file(frame_file(sinks.height_map), json_text(frame));
    job.summary["height_map"] = frame;
  }
  if (!sinks.hazard_map.empty()) write_hazard_map(job, sinks, map, part, *gravity);
}

}  // namespace astrolith
