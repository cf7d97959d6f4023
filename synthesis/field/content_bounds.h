// The content of a box, from bounds of the body and of the heights of its layers over the box, for CPU and
// GPU. F = s + elevation (synthesis/body/metaballs.h), with s = level / divisor for a plain body.
#pragma once

#include "numerics/interval.h"
#include "synthesis/body/metaball_body.h"
#include "synthesis/mesh/block_field.h"

namespace astrolith {

inline constexpr double kHeightSlack = 1e-5;  // rounding of heights and their sums, relative to their bound

// The content for a plain body on whose surface |level| <= reach.
ASTROLITH_HD inline BlockContent content_by_level(const MetaballInterval& bound, double reach) {
  if (bound.level_max < -reach) return BlockContent::kOutside;
  if (bound.level_min > reach) return BlockContent::kInside;
  return BlockContent::kMixed;
}
// The content for a plain body whose layers change F by at most `height`.
ASTROLITH_HD inline BlockContent content_by_height_bound(const MetaballInterval& bound, double height) {
  return content_by_level(bound, height * bound.gradient_max * (1.0 + kHeightSlack));
}

// The content for a body with operations, from bounds of s and of the heights.
ASTROLITH_HD inline BlockContent content_by_distance(const Interval& distance, const Interval& heights) {
  if (distance.high + heights.high < 0.0) return BlockContent::kOutside;
  if (distance.low + heights.low > 0.0) return BlockContent::kInside;
  return BlockContent::kMixed;
}

// The content for a plain body, from bounds of the heights over this box. smallest_divisor() is called only
// where all heights have one sign.
template <typename Divisor>
ASTROLITH_HD BlockContent content_by_heights(const MetaballInterval& bound, const Interval& heights,
                                             const Divisor& smallest_divisor) {
  const double divisor_max = bound.gradient_max;
  if (heights.high >= 0.0 && bound.level_max < -heights.high * divisor_max) return BlockContent::kOutside;
  if (heights.low <= 0.0 && bound.level_min > -heights.low * divisor_max) return BlockContent::kInside;
  if (heights.high >= 0.0 && heights.low <= 0.0) return BlockContent::kMixed;
  const double divisor_min = smallest_divisor();
  if (heights.high < 0.0 && bound.level_max < -heights.high * divisor_min) return BlockContent::kOutside;
  if (heights.low > 0.0 && bound.level_min > -heights.low * divisor_min) return BlockContent::kInside;
  return BlockContent::kMixed;
}

// A box that holds the projections on the bare surface of the points of `at`, for a plain body and for a body
// with operations. A projection moves a point by |s|, and by the bound of all heights at most, since no
// surface lies farther from the bare one. `divisor` is a lower bound of the divisor of s.
ASTROLITH_HD inline Box projected_box(const Box& at, const MetaballInterval& bound, double height_bound,
                                      double divisor) {
  const double level = std::max(std::fabs(bound.level_min), std::fabs(bound.level_max));
  const double distance = std::min(height_bound, level / divisor);
  return widened(at, distance * (1.0 + kHeightSlack) + 2e-6 * largest_coordinate(at));
}
ASTROLITH_HD inline Box projected_box(const Box& at, const Interval& distance, double height) {
  const double farthest = std::min(height, std::max(std::fabs(distance.low), std::fabs(distance.high)));
  return widened(at, farthest + 2e-6 * largest_coordinate(at));
}
// A box that holds the projections of both kinds of bodies, whatever s is in the box.
ASTROLITH_HD inline Box farthest_projected_box(const Box& at, double height_bound) {
  return widened(at, height_bound * (1.0 + kHeightSlack) + 2e-6 * largest_coordinate(at));
}

// A box that holds the points of `box` after each coordinate was displaced by at most `displaced` (length
// units).
ASTROLITH_HD inline Box displaced_layer_box(const Box& box, const Vec3d& displaced) {
  if (displaced.x == 0.0 && displaced.y == 0.0 && displaced.z == 0.0) return box;
  const Box moved{box.min - displaced, box.max + displaced};
  return widened(moved, 1e-6 * largest_coordinate(moved));
}

}  // namespace astrolith
