// Where a patch lies on a body, for CPU and GPU. Its coordinates are relative to an origin of double
// precision, and lie along the body's axes or along others, such as those of the ground.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/surface/ground_plane.h"
#include "numerics/interval.h"

namespace astrolith {

struct PatchPlace {
  Vec3d origin;
  bool turned = false;  // whether the coordinates lie along `axes`; else they lie along the body's
  GroundAxes axes{};

  // Without axes, coordinates lie along the body's.
  explicit PatchPlace(const Vec3d& at, const std::optional<GroundAxes>& along = {})
      : origin(at), turned(along.has_value()), axes(along.value_or(GroundAxes{})) {}

  // A point of the patch in coordinates along the body's axes, still relative to the origin.
  ASTROLITH_HD Vec3f along_body(const Vec3f& p) const {
    return turned ? to_float(axes.to_frame({double{p.x}, double{p.y}, double{p.z}})) : p;
  }

  // A box of the body's frame that holds every point of a box of the patch, after rounding to float
  // coordinates.
  ASTROLITH_HD Box in_body(const Box& local) const {
    const Box along = turned ? turned_box(local) : local;
    const Box moved{along.min + origin, along.max + origin};
    return widened(moved, 0x1p-23 * largest_coordinate(moved));
  }

 private:
  ASTROLITH_HD Box turned_box(const Box& local) const {
    const Vec3d half = 0.5 * local.extent(), center = axes.to_frame(local.center());
    const auto reach = [&](double right, double ahead, double up) {
      return half.x * std::fabs(right) + half.y * std::fabs(ahead) + half.z * std::fabs(up);
    };
    const Vec3d r{reach(axes.right.x, axes.ahead.x, axes.up.x), reach(axes.right.y, axes.ahead.y, axes.up.y),
                  reach(axes.right.z, axes.ahead.z, axes.up.z)};
    return {center - r, center + r};
  }
};

// A point relative to an origin in float coordinates of the body's frame.
ASTROLITH_HD inline Vec3f rounded_in_body(const Vec3d& origin, const Vec3f& p) {
  return {static_cast<float>(origin.x + double{p.x}), static_cast<float>(origin.y + double{p.y}),
          static_cast<float>(origin.z + double{p.z})};
}

}  // namespace astrolith
