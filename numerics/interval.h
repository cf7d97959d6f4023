// Interval arithmetic and boxes for the bounds of fields, on the CPU and on a GPU.
#pragma once

#include <algorithm>
#include <cmath>

#include "numerics/host_device.h"
#include "numerics/scalar_math.h"
#include "numerics/vec3.h"

namespace astrolith {

// The values that a quantity may take, with rounding in float included: low <= high.
struct Interval {
  double low = 0.0, high = 0.0;
};

// The largest |coordinate| of any point of the box. Rounding errors of float positions are proportional to
// it.
ASTROLITH_HD inline double largest_coordinate(const Box& box) {
  const double x = std::max(std::fabs(box.min.x), std::fabs(box.max.x)),
               y = std::max(std::fabs(box.min.y), std::fabs(box.max.y)),
               z = std::max(std::fabs(box.min.z), std::fabs(box.max.z));
  return std::max(std::max(x, y), z);
}

// The largest distance of a lattice cell from the origin along an axis, in cells. Up to 2^20 cells a float
// coordinate keeps at least three bits within a cell. Farther out points of one cell would fall together.
inline constexpr double kLargestCell = 0x1p20;

// v, or the nearest number in low .. high.
ASTROLITH_HD inline double clamped(double v, double low, double high) {
  return std::min(std::max(v, low), high);
}
// The point of the box low .. high that is nearest to p.
ASTROLITH_HD inline Vec3d moved_into(const Vec3d& p, const Vec3f& low, const Vec3f& high) {
  return {clamped(p.x, double{low.x}, double{high.x}), clamped(p.y, double{low.y}, double{high.y}),
          clamped(p.z, double{low.z}, double{high.z})};
}
ASTROLITH_HD inline Vec3f moved_into(const Vec3f& p, const Vec3f& low, const Vec3f& high) {
  return {math::clamp(p.x, low.x, high.x), math::clamp(p.y, low.y, high.y), math::clamp(p.z, low.z, high.z)};
}
// The box of the points of `box` after each has been clamped into low .. high.
ASTROLITH_HD inline Box moved_into(const Box& box, const Vec3f& low, const Vec3f& high) {
  return {moved_into(box.min, low, high), moved_into(box.max, low, high)};
}

ASTROLITH_HD inline Interval plus(const Interval& a, const Interval& b) {
  return {a.low + b.low, a.high + b.high};
}
// The product of two intervals that hold no negative number.
ASTROLITH_HD inline Interval product(const Interval& a, const Interval& b) {
  return {a.low * b.low, a.high * b.high};
}
ASTROLITH_HD inline Interval scaled(double factor, const Interval& a) {
  return {std::min(factor * a.low, factor * a.high), std::max(factor * a.low, factor * a.high)};
}

}  // namespace astrolith
