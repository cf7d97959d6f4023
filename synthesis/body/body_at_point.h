// The bare body at one point, for CPU and GPU. The results have the bits of evaluate_body (body_tables.h).
#pragma once

#include "synthesis/body/body_tables.h"
#include "synthesis/body/local_metaballs.h"
#include "synthesis/body/surface_projection.h"

namespace astrolith {

// s and grad L of the metaballs of leaf `number`. The point p is already warped by the warp of the leaf.
ASTROLITH_HD inline SurfaceDistance<float> leaf_distance(const BodyLeaf& leaf, const LeafLists& lists,
                                                         std::uint32_t number, const Vec3f& p) {
  std::uint32_t j = lists.first[number];
  const std::uint32_t end = lists.first[number + 1];
  MetaballTotals<float> totals{};
  for (; j < end && !lists.spheres[j].subtractive(); ++j) {
    accumulate_metaball(leaf.metaballs, lists.spheres[j], p, totals.added);
  }
  if (j == end) return metaball_distance(leaf.metaballs, totals.added);
  for (; j < end; ++j)
    accumulate_metaball(leaf.metaballs, lists.spheres[j].as_adding(), p, totals.subtracted);
  return metaball_distance(leaf.metaballs, totals.net());
}

// The signed distance s, a vector along its gradient, and the warped point at which a plain body was
// evaluated.
struct BodyAtPoint {
  float distance;
  Vec3f gradient, at;
};

// A leaf as an operand of operations: its gradient is divided by its length.
ASTROLITH_HD inline BodySample operand_at(const BodyLeaf& leaf, const ArrayView& arrays,
                                          const LeafLists& lists, std::uint32_t number, const Vec3f& p) {
  if (leaf.grid.exists()) return spline_distance(leaf.grid, arrays[leaf.grid.coefficients], p);
  const SurfaceDistance<float> d =
      leaf_distance(leaf, lists, number, leaf.warped ? warped(leaf.warp, arrays, p) : p);
  const Vec3f& g = d.log_gradient;
  const float length = gradient_length(g.x, g.y, g.z, leaf.metaballs.gradient_floor);
  return {d.distance, g.x / length, g.y / length, g.z / length};
}

// The body at p. If the body is plain, p is already warped by its warp.
ASTROLITH_HD inline BodyAtPoint unwarped_body_at(const BodyTables& body, const ArrayView& arrays,
                                                 const LeafLists& lists, const Vec3f& p) {
  const BodyLeaf* leaves = arrays[body.leaves];
  if (body.plain()) {
    const SurfaceDistance<float> d = leaf_distance(leaves[0], lists, 0, p);
    return {d.distance, d.log_gradient, p};
  }
  const BodyStep* steps = arrays[body.steps];
  BodySample stack[kMaxOperationDepth + 2];
  int size = 0;
  for (std::uint32_t i = 0; i < body.steps.count; ++i) {
    if (steps[i].is_leaf) {
      stack[size++] = operand_at(leaves[steps[i].leaf], arrays, lists, steps[i].leaf, p);
    } else {
      --size;
      stack[size - 1] = combined(steps[i].combine, stack[size - 1], stack[size]);
    }
  }
  return {stack[0].distance, {stack[0].gx, stack[0].gy, stack[0].gz}, p};
}

// A plain body at the point origin + p, with the bits of evaluate_local_metaballs() (local_metaballs.h). The
// point is already warped by the warp of the body; `at` of the result is relative to the origin too.
ASTROLITH_HD inline BodyAtPoint local_plain_body_at(const BodyTables& body, const ArrayView& arrays,
                                                    const LeafLists& lists, const Vec3d& origin,
                                                    const Vec3f& p) {
  const MetaballParameters<double> parameters = in_double((*arrays[body.leaves]).metaballs);
  const SurfaceDistance<double> d =
      local_distance(parameters, lists.spheres + lists.first[0], lists.first[1] - lists.first[0], origin, p);
  return {static_cast<float>(d.distance), to_float(d.log_gradient), p};
}

ASTROLITH_HD inline BodyAtPoint body_at(const BodyTables& body, const ArrayView& arrays,
                                        const LeafLists& lists, const Vec3f& p) {
  const BodyLeaf& first = *arrays[body.leaves];
  const bool warps = body.plain() && first.warped;
  return unwarped_body_at(body, arrays, lists, warps ? warped(first.warp, arrays, p) : p);
}

// The first-order projection of the point on the bare surface, at most `longest_step` away.
ASTROLITH_HD inline Vec3f projected_point(const BodyAtPoint& body, float gradient_floor, float longest_step) {
  const Vec3f &g = body.gradient, &p = body.at;
  const float length = gradient_length(g.x, g.y, g.z, gradient_floor);
  const auto along = [&](float c, float slope) {
    return projected_coordinate(c, slope, length, body.distance, longest_step);
  };
  return {along(p.x, g.x), along(p.y, g.y), along(p.z, g.z)};
}

// A projection of the point, lifted along the outward normal by an elevation.
ASTROLITH_HD inline Vec3f lifted_point(const BodyAtPoint& body, float gradient_floor, const Vec3f& projected,
                                       float elevation) {
  const Vec3f& g = body.gradient;
  const float length = gradient_length(g.x, g.y, g.z, gradient_floor);
  return {lifted_coordinate(projected.x, g.x, length, elevation),
          lifted_coordinate(projected.y, g.y, length, elevation),
          lifted_coordinate(projected.z, g.z, length, elevation)};
}

}  // namespace astrolith
