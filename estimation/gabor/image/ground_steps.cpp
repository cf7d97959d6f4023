#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>

#include "estimation/gabor/image/raster_file_internal.h"
#include "numerics/portable_angles.h"

namespace astrolith {
namespace {

using GeoTransform = std::array<double, 6>;
constexpr GeoTransform kNoTransform{0.0, 1.0, 0.0, 0.0, 0.0, 1.0};

// The metres of a degree, or of what the frame counts, along a meridian and along the parallel of a latitude.
GroundStep degree_metres(const OGRSpatialReference& frame, double latitude) {
  const double angle = frame.GetAngularUnits(), metres = frame.GetSemiMajor() * angle;
  constexpr double kPole = 1.6;
  return {std::abs(latitude * angle) < kPole ? metres * portable::cos(latitude * angle) : 0.0, metres};
}

std::string degrees_words(const OGRSpatialReference& frame) {
  return fmt::format("degrees on a body of radius {:.6g} km", frame.GetSemiMajor() / 1e3);
}

// The coordinates of the middle, and of its next pixels along the row and along the column.
struct MiddlePixels {
  std::array<double, 3> x, y;
};
MiddlePixels middle_pixels(GDALDataset& raster, const GeoTransform& t) {
  const double column = 0.5 * raster.GetRasterXSize(), row = 0.5 * raster.GetRasterYSize();
  const double x = t[0] + column * t[1] + row * t[2], y = t[3] + column * t[4] + row * t[5];
  return {{x, x + t[1], x + t[2]}, {y, y + t[4], y + t[5]}};
}

// Whether the map would be at least half as wide and half as high as a globe's, and no larger.
bool like_a_globe(GDALDataset& raster, const GeoTransform& t) {
  const double width = raster.GetRasterXSize() * t[1], height = raster.GetRasterYSize() * t[5];
  const double west = std::min(t[0], t[0] + width), east = std::max(t[0], t[0] + width);
  const double south = std::min(t[3], t[3] + height), north = std::max(t[3], t[3] + height);
  const double play = 0.5 * std::abs(t[1]);  // registered to the middles of pixels
  return west >= -180.0 - play && east <= 360.0 + play && east - west >= 180.0 && south >= -90.0 - play &&
         north <= 90.0 + play && north - south >= 90.0;
}

// To six digits, which the libraries of all machines agree on.
double rounded(double value) {
  const std::string text = fmt::format("{:.6g}", value);
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

// Whether PROJ finds its database. Without it, PROJ gives frames a wrong unit and coordinates as they are.
bool has_projection_data() { return OGRSpatialReference().importFromEPSG(4326) == OGRERR_NONE; }

// The steps on the body, whose pixels are other than those of the plane where the projection stretches the
// ground by 2 % or more. None where PROJ cannot tell them.
std::optional<GroundSteps> unprojected(const OGRSpatialReference& frame, MiddlePixels middle,
                                       const GroundSteps& in_plane) {
  constexpr double kStretch = 0.02;
  const double plain = in_plane.column.length();
  OGRSpatialReference plane(frame);
  const std::unique_ptr<OGRSpatialReference> globe(frame.CloneGeogCS());
  if (globe == nullptr) return {};
  plane.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  globe->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::unique_ptr<OGRCoordinateTransformation> way(
      OGRCreateCoordinateTransformation(&plane, globe.get()));
  if (way == nullptr || way->Transform(3, middle.x.data(), middle.y.data()) == 0) return {};
  const GroundStep metres = degree_metres(*globe, middle.y[0]);
  const auto step = [&](std::size_t k) {
    return GroundStep{rounded(metres.east * (middle.x[k] - middle.x[0])),
                      rounded(metres.north * (middle.y[k] - middle.y[0]))};
  };
  GroundSteps steps = in_plane;
  steps.column = step(1), steps.row = step(2);
  const double width = steps.column.length(), height = steps.row.length();
  const auto differs = [&](double side) { return !(std::abs(side - plain) <= kStretch * plain); };
  if (!(width < 4.0 * plain && height < 4.0 * plain)) return {};
  if (!differs(width) && !differs(height)) return in_plane;
  steps.source = fmt::format("on the ground, where the projection has {:.6g} m", plain);
  return steps;
}

std::optional<GroundSteps> steps_without_turn(GDALDataset& raster, const GeoTransform& t) {
  const OGRSpatialReference* frame = raster.GetSpatialRef();
  const MiddlePixels middle = middle_pixels(raster, t);
  GroundStep unit{1.0, 1.0};
  GroundSteps steps;
  if (frame == nullptr) {
    const bool like_degrees = t[0] != 0.0 && std::abs(middle.x[0]) <= 360.0 &&
                              std::abs(middle.y[0]) <= 90.0 && std::abs(t[1]) < 0.1;
    steps.like_degrees = like_a_globe(raster, t);
    steps.perhaps_degrees = like_degrees;
    steps.source =
        like_degrees ? "no unit is stated; if they are degrees, give --mm-per-px" : "no unit is stated";
  } else if (frame->IsGeographic() != 0) {
    unit = degree_metres(*frame, middle.y[0]);
    steps.source = degrees_words(*frame);
  } else {
    const char* name = nullptr;
    unit.east = unit.north = frame->GetLinearUnits(&name);
    if (unit.east != 1.0 && name != nullptr) steps.plane_unit = name;
  }
  steps.column = {unit.east * t[1], unit.north * t[4]};
  steps.row = {unit.east * t[2], unit.north * t[5]};
  if (frame == nullptr) return steps;
  if (has_projection_data()) {
    if (frame->IsProjected() == 0) return steps;
    if (auto on_ground = unprojected(*frame, middle, steps)) return on_ground;
  }
  steps.unknown = true;
  steps.source = "of a map that PROJ cannot evaluate";
  return steps;
}

}  // namespace

std::optional<GroundSteps> ground_steps(GDALDataset& raster) {
  GeoTransform t = kNoTransform;
  // GDAL calls a transform invalid that has a size of pixels and no place on the ground.
  if (raster.GetGeoTransform(t.data()) != CE_None && t == kNoTransform) return {};
  std::optional<GroundSteps> steps = steps_without_turn(raster, t);
  // A place in the picture itself is no place on the ground.
  if (!steps || t == kNoTransform) return steps;
  steps->west = t[1] < 0.0;
  // Whether the map is the ground's mirror image once its columns run to the east.
  steps->south = (t[1] * t[5] - t[2] * t[4]) * (steps->west ? -1.0 : 1.0) > 0.0;
  return steps;
}

std::string vertical_unit(GDALDataset& raster) {
  const OGRSpatialReference* frame = raster.GetSpatialRef();
  if (frame == nullptr || frame->IsCompound() == 0) return "";
  const char* name = nullptr;
  frame->GetTargetLinearUnits("VERT_CS", &name);
  return name == nullptr ? "" : name;
}

}  // namespace astrolith
