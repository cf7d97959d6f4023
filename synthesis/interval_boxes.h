// Boxes and intervals as the bounds of fields use them, on CPU and GPU.
#pragma once

#include <algorithm>

#include "synthesis/largest_coordinate.h"
#include "synthesis/noise_octaves.h"

namespace astrolith {

ASTROLITH_HD inline Vec3d center_of(const Box& box) { return 0.5 * (box.min + box.max); }
ASTROLITH_HD inline Vec3d extent_of(const Box& box) { return box.max - box.min; }

// By `margin` on every side.
ASTROLITH_HD inline Box box_around(const Box& box, double margin) {
  const Vec3d m{margin, margin, margin};
  return {box.min - m, box.max + m};
}

// Whether they share a point.
ASTROLITH_HD inline bool boxes_touch(const Box& a, const Box& b) {
  return a.min.x <= b.max.x && a.max.x >= b.min.x && a.min.y <= b.max.y && a.max.y >= b.min.y &&
         a.min.z <= b.max.z && a.max.z >= b.min.z;
}

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
