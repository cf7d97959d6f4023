// What is certain about the bare body over boxes, for CPU and GPU.
#pragma once

#include "synthesis/body/body_tables.h"
#include "synthesis/body/compact_kernel_bounds.h"
#include "synthesis/body/operator_bounds.h"

namespace astrolith {

// Where a body is evaluated for the points of a box: a plain body on the other side of its warp.
ASTROLITH_HD inline Box body_box(const BodyTables& body, const ArrayView& arrays, const Box& box) {
  const BodyLeaf& first = *arrays[body.leaves];
  return body.plain() && first.warped ? warped_box(first.warp, arrays, box) : box;
}

// Where the metaballs of a leaf are evaluated, from the body_box() of a box.
ASTROLITH_HD inline Box leaf_box(const BodyTables& body, const ArrayView& arrays, std::uint32_t number,
                                 const Box& at) {
  const BodyLeaf& leaf = arrays[body.leaves][number];
  return !body.plain() && leaf.warped ? warped_box(leaf.warp, arrays, at) : at;
}

// s at every float point of a box, of a body with operations; never wrong. It is tighter for what is farther
// than `height` from a surface. `lists.metaballs(leaf)` holds the metaballs that reach the box; `scratch`
// takes as many as the longest of these lists.
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
