// Bounds of the bare body over boxes, for CPU and GPU.
#pragma once

#include "synthesis/body/body_tables.h"
#include "synthesis/body/compact_kernel_bounds.h"
#include "synthesis/body/operator_bounds.h"

namespace astrolith {

// A box that holds the points at which the body is evaluated for the points of `box`: their warped images if
// the body is plain and warped, else the points themselves.
ASTROLITH_HD inline Box body_box(const BodyTables& body, const ArrayView& arrays, const Box& box) {
  const BodyLeaf& first = *arrays[body.leaves];
  return body.plain() && first.warped ? warped_box(first.warp, arrays, box) : box;
}

// A box that holds the points at which the metaballs of leaf `number` are evaluated. `at` is the body_box()
// of the original box.
ASTROLITH_HD inline Box leaf_box(const BodyTables& body, const ArrayView& arrays, std::uint32_t number,
                                 const Box& at) {
  const BodyLeaf& leaf = arrays[body.leaves][number];
  return !body.plain() && leaf.warped ? warped_box(leaf.warp, arrays, at) : at;
}

// An interval that holds s for every float point of a box, in length units. Expects a body with operations.
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
