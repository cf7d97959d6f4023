// The bare body of a flat field at one point: evaluate_body (combined_body.h), bit for bit.
#pragma once

#include "synthesis/body/surface_projection.h"
#include "synthesis/field/flat_field.h"
#include "synthesis/noise/octave_sum.h"

namespace astrolith {

// p + warp(p).
ASTROLITH_HD inline Vec3f flat_warped(const FlatField& f, const FlatWarp& warp, const Vec3f& p) {
  const Vec3f q{math::clamp(p.x, warp.low.x, warp.high.x), math::clamp(p.y, warp.low.y, warp.high.y),
                math::clamp(p.z, warp.low.z, warp.high.z)};
  const auto along = [&](const FlatRange& octaves, float coordinate) {
    for (std::uint32_t o = octaves.first; o < octaves.first + octaves.count; ++o) {
      coordinate = with_octave(Noise::kSimplex, f.octaves[o], q, coordinate);
    }
    return coordinate;
  };
  return {along(warp.octaves[0], p.x), along(warp.octaves[1], p.y), along(warp.octaves[2], p.z)};
}

// s and grad L of a leaf's metaballs.
ASTROLITH_HD inline SurfaceDistance<float> flat_leaf(const FlatField& f, const FlatBlock& block,
                                                     std::uint32_t leaf, const Vec3f& p) {
  const MetaballParameters<float>& body = f.leaves[leaf].body;
  std::uint32_t j = block.first_sphere[leaf];
  const std::uint32_t end = block.first_sphere[leaf + 1];
  MetaballTotals<float> totals{};
  for (; j < end && !block.spheres[j].subtractive(); ++j) {
    accumulate_metaball(body, block.spheres[j], p, totals.added);
  }
  if (j == end) return metaball_distance(body, totals.added);
  for (; j < end; ++j) accumulate_metaball(body, block.spheres[j].as_adding(), p, totals.subtracted);
  return metaball_distance(body, totals.net());
}

// s, its gradient's direction, and where a plain body was evaluated.
struct FlatBodySample {
  float distance;
  Vec3f gradient, at;
};

// The gradient over its length.
ASTROLITH_HD inline BodySample flat_operand(const FlatField& f, const FlatBlock& block, std::uint32_t number,
                                            const Vec3f& p) {
  const FlatLeaf& leaf = f.leaves[number];
  const SurfaceDistance<float> d =
      flat_leaf(f, block, number, leaf.warped ? flat_warped(f, leaf.warp, p) : p);
  const Vec3f& g = d.log_gradient;
  const float length = gradient_length(g.x, g.y, g.z, leaf.body.gradient_floor);
  return {d.distance, g.x / length, g.y / length, g.z / length};
}

ASTROLITH_HD inline FlatBodySample flat_body(const FlatField& f, const FlatBlock& block, const Vec3f& p) {
  if (f.num_steps == 0) {
    const Vec3f at = f.leaves[0].warped ? flat_warped(f, f.leaves[0].warp, p) : p;
    const SurfaceDistance<float> d = flat_leaf(f, block, 0, at);
    return {d.distance, d.log_gradient, at};
  }
  BodySample stack[kMaxOperationDepth + 2];
  int size = 0;
  for (std::uint32_t i = 0; i < f.num_steps; ++i) {
    const FlatStep& step = f.steps[i];
    if (step.is_leaf) {
      stack[size++] = flat_operand(f, block, step.leaf, p);
    } else {
      --size;
      stack[size - 1] = combined(step.combine, stack[size - 1], stack[size]);
    }
  }
  return {stack[0].distance, {stack[0].gx, stack[0].gy, stack[0].gz}, p};
}

// First-order projection on the bare surface.
ASTROLITH_HD inline Vec3f flat_projected(const FlatField& f, const FlatBodySample& body) {
  const Vec3f &g = body.gradient, &p = body.at;
  const float length = gradient_length(g.x, g.y, g.z, f.leaves[0].body.gradient_floor);
  const auto along = [&](float c, float slope) {
    return projected_coordinate(c, slope, length, body.distance, f.longest_step);
  };
  return {along(p.x, g.x), along(p.y, g.y), along(p.z, g.z)};
}

}  // namespace astrolith
