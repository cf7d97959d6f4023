// Bounds of the bare body over boxes, for CPU and GPU.
#pragma once

#include "synthesis/body/body_tables.h"
#include "synthesis/body/compact_kernel_bounds.h"
#include "synthesis/body/operator_bounds.h"

namespace astrolith {

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
