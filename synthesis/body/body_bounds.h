// Bounds of the bare body over boxes, combined bodies included, for CPU and GPU.
#pragma once

#include "numerics/interval.h"
#include "synthesis/body/body_operators.h"
#include "synthesis/body/body_tables.h"
#include "synthesis/body/compact_kernel_bounds.h"
#include "synthesis/body/metaball_body.h"

namespace astrolith {

// An interval that holds s of metaballs over a box, from the bounds `all` of their level and divisor.
// `surface_gradient` is an upper bound of the divisor at the points with |s| <= height. It makes the interval
// tighter if the box is farther than `height` from the surface.
ASTROLITH_HD inline Interval bound_leaf_distance(const MetaballParameters<float>& body,
                                                 const MetaballInterval& all, double height,
                                                 double surface_gradient) {
  const double least = 0.999 * std::sqrt(double{body.gradient_floor});
  Interval s{all.level_min / (all.level_min > 0.0 ? all.gradient_max : least),
             all.level_max / (all.level_max < 0.0 ? all.gradient_max : least)};
  const double reach = height * surface_gradient;
  if (all.level_max < -reach) s.high = std::min(s.high, -height);
  if (all.level_min > reach) s.low = std::max(s.low, height);
  return s;
}
// Whether a bound of the divisor near the surface can make bound_leaf_distance() tighter.
ASTROLITH_HD inline bool is_off_surface(const MetaballInterval& all, double height) {
  return height != 0.0 && (all.level_min > 0.0 || all.level_max < 0.0);
}

// The range of (v / reach)^2 for v in an interval.
ASTROLITH_HD inline Interval reach_squares(const Interval& v, double inverse_reach) {
  const double a = v.low * inverse_reach, b = v.high * inverse_reach;
  const double nearest = a > 0.0 ? a : b < 0.0 ? b : 0.0, farthest = std::max(std::fabs(a), std::fabs(b));
  return {nearest * nearest, farthest * farthest};
}

// An interval that holds the combined distance for all operands in f and g, with float rounding.
ASTROLITH_HD inline Interval bound_combined(const OperatorParameters<double>& o, const Interval& f,
                                            const Interval& g) {
  const bool difference = o.kind == Operator::kDifference;
  Interval s{monotone_combined(o, f.low, difference ? g.high : g.low),
             monotone_combined(o, f.high, difference ? g.low : g.high)};
  if (o.kind == Operator::kCleanUnion) {
    const Interval u = reach_squares(f, o.inverse_reach[0]), v = reach_squares(g, o.inverse_reach[1]);
    const double nearest = o.bulge / (1.0 + u.low + v.low), farthest = o.bulge / (1.0 + u.high + v.high);
    s.low += std::min(nearest, farthest) - 1e-5 * std::fabs(o.bulge);
    s.high += std::max(nearest, farthest) + 1e-5 * std::fabs(o.bulge);
  }
  const double rounding = o.kind == Operator::kBlend ? 1e-5 * o.width : 0.0;
  return {s.low - 2e-5 * std::fabs(s.low) - rounding, s.high + 2e-5 * std::fabs(s.high) + rounding};
}

// An interval that holds s for every float point of a box, in length units. Expects a body that is not plain.
// The interval is tighter if surfaces of operands are farther than `height` from the box.
// `lists.metaballs(leaf)` holds the metaballs of a leaf that reach the box; `scratch` has room for the
// longest of these lists.
template <class Lists>
ASTROLITH_HD Interval bound_distance(const BodyTables& body, const ArrayView& arrays, const Lists& lists,
                                     const Box& box, double height, KernelInterval* scratch) {
  const BodyLeaf* leaves = arrays[body.leaves];
  const BodyStep* steps = arrays[body.steps];
  Interval stack[kMaxOperationDepth + 2];
  int size = 0;
  for (std::uint32_t i = 0; i < body.steps.count; ++i) {
    if (!steps[i].is_leaf) {
      --size;
      stack[size - 1] = bound_combined(steps[i].bounds, stack[size - 1], stack[size]);
      continue;
    }
    const SplineGrid& grid = leaves[steps[i].leaf].grid;
    if (grid.exists()) {
      stack[size++] = bound_spline_distance(grid, arrays[grid.coefficients], box);
      continue;
    }
    const MetaballParameters<float>& leaf = leaves[steps[i].leaf].metaballs;
    const MetaballList spheres = lists.metaballs(steps[i].leaf);
    const Box at = leaf_box(body, arrays, steps[i].leaf, box);
    const MetaballInterval all =
        bound_metaballs(leaf, spheres, at, std::numeric_limits<double>::infinity(), scratch);
    const double gradient =
        is_off_surface(all, height) ? bound_metaballs(leaf, spheres, at, height, scratch).gradient_max : 0.0;
    stack[size++] = bound_leaf_distance(leaf, all, height, gradient);
  }
  return stack[0];
}

}  // namespace astrolith
