#include <algorithm>
#include <cmath>

#include "geometry/surface/footprint_planes.h"
#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "numerics/length_unit.h"
#include "synthesis/field/feature_list.h"
#include "synthesis/picture/image_file.h"
#include "tasks/job/output_names.h"
#include "tasks/synth/ground_maps.h"

namespace astrolith {
namespace {

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

// Raises the third band to the boulder's diameter where a footprint reaches it, seen from above.
void mark_boulder(const PlacedBoulder& boulder, const HeightMap& map, const Vec3d& center, double metres,
                  double footprint, std::vector<float>& bands) {
  const double diameter = std::max({boulder.axes.x, boulder.axes.y, boulder.axes.z});
  const double radius = 0.5 * diameter / map.pixel, half = 0.5 * footprint / map.pixel;
  const Vec3d d = boulder.center - center - map.origin;
  const double x = dot(d, map.right) / map.pixel + 0.5 * map.side - 0.5,
               y = 0.5 * map.side - 0.5 - dot(d, map.ahead) / map.pixel;
  const double reach = radius + half, last = map.side - 1.0;
  for (int j = static_cast<int>(std::ceil(std::max(y - reach, 0.0))); j <= std::min(y + reach, last); ++j) {
    for (int i = static_cast<int>(std::ceil(std::max(x - reach, 0.0))); i <= std::min(x + reach, last); ++i) {
      const double across = std::max(std::fabs(i - x) - half, 0.0),
                   along = std::max(std::fabs(j - y) - half, 0.0);
      if (across * across + along * along > radius * radius) continue;
      float& band =
          bands[kBands * (static_cast<std::size_t>(j) * map.side + static_cast<std::size_t>(i)) + 2];
      if (band < metres * diameter) band = static_cast<float>(metres * diameter);  // unless it is NaN
    }
  }
}

nlohmann::ordered_json largest_values(const std::vector<float>& bands) {
  nlohmann::ordered_json largest;
  for (std::size_t k = 0; k < kBands; ++k) {
    float most = 0.0f;
    for (std::size_t i = k; i < bands.size(); i += kBands) most = std::fmax(most, bands[i]);
    largest[kBandNames[k]] = most;
  }
  return largest;
}

}  // namespace

void check_hazard_map(const HazardRequest& request, const Region& region, const Recipe& recipe,
                      int resolution) {
  if (request.file.empty()) return;
  check_map(request.file, "--hazard-map", region, recipe, resolution);
  if (!(request.footprint > 0.0)) {
    throw InputError(
        "--hazard-map: needs the side of the ground that a lander stands on; add --footprint L, in the "
        "recipe's unit");
  }
  const double pixel = region.size / resolution;
  if (request.footprint < 3.0 * pixel || request.footprint > 0.5 * region.size) {
    throw InputError(
        "--footprint: is less than 3 pixels or more than half the patch; change --resolution or the patch");
  }
}

void write_hazard_map(Job& job, const HazardRequest& request, const HeightMap& map, const PatchGround& ground,
                      const SurfaceGravity& gravity) {
  const double metres = metres_of(ground.recipe.length_unit);
  const int half = half_footprint(request.footprint, map.pixel);
  HeightMap in_metres = map;
  in_metres.pixel *= metres;
  const std::vector<FootprintPlane> planes = footprint_planes(in_metres, half);
  const VerticalLattice verticals(map, ground.region.center, metres, gravity);
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
  for (const Feature& landform : features_of(ground.field, ground.region.cube())) {
    if (landform.boulder != nullptr && is_resolved(landform, map.pixel))
      mark_boulder(*landform.boulder, map, ground.region.center, metres, map.pixel * (2 * half + 1), bands);
  }
  nlohmann::ordered_json frame = frame_json(map, ground);
  frame["footprint_m"] = metres * map.pixel * (2 * half + 1);
  frame["largest"] = largest_values(bands);
  write_geotiff(bands, map.side, map.side, metres * map.pixel,
                frame.dump(-1, ' ', true, nlohmann::ordered_json::error_handler_t::replace), request.file,
                kBandNames);
  job.summary["hazard_map"] = {{"footprint_m", frame["footprint_m"]}, {"largest", frame["largest"]}};
}

}  // namespace astrolith
