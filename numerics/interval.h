// Intervals and boxes as the bounds of fields use them, on CPU and GPU.
#pragma once

#include <algorithm>
#include <cmath>

#include "numerics/host_device.h"
#include "numerics/vec3.h"

namespace astrolith {

// All values that a quantity takes, float rounding included.
struct Interval {
  double low = 0.0, high = 0.0;
};

// The largest |coordinate| of a point of the box: float positions in the box are rounded in proportion to it.
ASTROLITH_HD inline double largest_coordinate(const Box& box) {
  const double x = std::max(std::fabs(box.min.x), std::fabs(box.max.x)),
               y = std::max(std::fabs(box.min.y), std::fabs(box.max.y)),
               z = std::max(std::fabs(box.min.z), std::fabs(box.max.z));
  return std::max(std::max(x, y), z);
}

// How many cells from the origin a lattice may reach, along an axis: 2^20. Farther out a float coordinate,
// counted in cells, has fewer than three bits left within a cell, and points of one cell fall together.
inline constexpr double kLargestCell = 0x1p20;

ASTROLITH_HD inline double clamped(double v, double low, double high) {
  return std::min(std::max(v, low), high);
}
ASTROLITH_HD inline Vec3d moved_into(const Vec3d& p, const Vec3f& low, const Vec3f& high) {
  return {clamped(p.x, double{low.x}, double{high.x}), clamped(p.y, double{low.y}, double{high.y}),
          clamped(p.z, double{low.z}, double{high.z})};
}
// What the points of a box become that are moved into the domain low .. high.
ASTROLITH_HD inline Box moved_into(const Box& box, const Vec3f& low, const Vec3f& high) {
  return {moved_into(box.min, low, high), moved_into(box.max, low, high)};
}

ASTROLITH_HD inline Interval plus(const Interval& a, const Interval& b) {
  return {a.low + b.low, a.high + b.high};
}
// Of intervals that do not reach below 0.
ASTROLITH_HD inline Interval product(const Interval& a, const Interval& b) {
  return {a.low * b.low, a.high * b.high};
}
ASTROLITH_HD inline Interval scaled(double factor, const Interval& a) {
  return {std::min(factor * a.low, factor * a.high), std::max(factor * a.low, factor * a.high)};
}

}  // namespace astrolith
