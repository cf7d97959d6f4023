// What is certain about a flat field over a box: content_of (field_model_internal.h), bit for bit, for CPU
// and GPU. A box comes with lists of what of the field reaches it.
#pragma once

#include "synthesis/body/compact_kernel_bounds.h"
#include "synthesis/body/operator_bounds.h"
#include "synthesis/field/content_bounds.h"
#include "synthesis/field/flat_field.h"
#include "synthesis/field/join_bounds.h"
#include "synthesis/landforms/crater_bounds.h"
#include "synthesis/noise/octave_bounds.h"
#include "synthesis/noise/sparse_bounds.h"
#include "synthesis/spots/spot_bounds.h"

namespace astrolith {

// Of list l: numbers[ranges[l].first] and on. First the metaballs of each leaf, then the craters of each
// layer of such, last the boulders.
struct FlatNear {
  const std::uint32_t* numbers;
  const FlatRange* ranges;

  ASTROLITH_HD MetaballList metaballs(const FlatField& f, std::uint32_t leaf) const {
    return {f.spheres, numbers + ranges[leaf].first, ranges[leaf].count};
  }
};

// Holds p + warp(p) for the points of a box.
ASTROLITH_HD inline Box flat_image(const FlatField& f, const FlatWarp& warp, const Box& box) {
  const Box inside = moved_into(box, warp.low, warp.high);
  const auto along = [&](const FlatRange& octaves) {
    return bound_octaves(Noise::kSimplex, f.octaves + octaves.first, octaves.count, inside, false);
  };
  return displaced_box(box, along(warp.octaves[0]), along(warp.octaves[1]), along(warp.octaves[2]),
                       warp.bound);
}
// Where the metaballs of a leaf are evaluated for the points of a box.
ASTROLITH_HD inline Box flat_leaf_box(const FlatField& f, std::uint32_t leaf, const Box& box) {
  return f.leaves[leaf].warped ? flat_image(f, f.leaves[leaf].warp, box) : box;
}
// And the body, whose operands have warps of their own.
ASTROLITH_HD inline Box flat_body_box(const FlatField& f, const Box& box) {
  return f.num_steps == 0 ? flat_leaf_box(f, 0, box) : box;
}

// Which metaballs of a leaf reach the points of flat_leaf_box(), and which craters and boulders a box.
ASTROLITH_HD inline bool metaball_reaches(const FlatField& f, std::uint32_t leaf, std::uint32_t number,
                                          const Box& leaf_box) {
  return reaches_box(f.spheres[number], double{f.leaves[leaf].body.cutoff_squared}, leaf_box);
}
ASTROLITH_HD inline bool boulder_reaches(const FlatField& f, std::uint32_t number, const Box& box) {
  return boxes_touch({f.boulders[number].low, f.boulders[number].high}, box);
}

// s of a body with operations.
ASTROLITH_HD inline Interval flat_bound_distance(const FlatField& f, const FlatNear& near, const Box& box,
                                                 double height, KernelInterval* scratch) {
  Interval stack[kMaxOperationDepth + 2];
  int size = 0;
  for (std::uint32_t i = 0; i < f.num_steps; ++i) {
    const FlatStep& step = f.steps[i];
    if (!step.is_leaf) {
      --size;
      stack[size - 1] = bound_combined(step.bounds, stack[size - 1], stack[size]);
      continue;
    }
    const MetaballParameters<float>& body = f.leaves[step.leaf].body;
    const MetaballList spheres = near.metaballs(f, step.leaf);
    const Box at = flat_leaf_box(f, step.leaf, box);
    const MetaballInterval all =
        bound_metaballs(body, spheres, at, std::numeric_limits<double>::infinity(), scratch);
    const double gradient =
        is_off_surface(all, height) ? bound_metaballs(body, spheres, at, height, scratch).gradient_max : 0.0;
    stack[size++] = bound_leaf_distance(body, all, height, gradient);
  }
  return stack[0];
}

ASTROLITH_HD inline Interval flat_bound_spots(const FlatField& f, const FlatLayer& layer, const Box& box) {
  const Box moved = moved_into(box, layer.low, layer.high);
  const double slack = 3.0 * kSpotSlack * layer.height_bound;
  Interval sum{-slack, slack};
  for (std::uint32_t s = layer.parts.first; s < layer.parts.first + layer.parts.count; ++s) {
    sum = plus(sum, bound_drawn_spots(f.spots[s].kind, f.spot_thresholds, moved));
  }
  return sum;
}

// Heights of a layer other than craters over the box where it is evaluated.
ASTROLITH_HD inline Interval flat_bound_layer(const FlatField& f, const FlatLayer& layer, const Box& box) {
  if (layer.kind == FlatNoise::kFractal) {
    const Box p = layer.warped ? flat_image(f, layer.warp, box) : box;
    return bound_octaves(layer.noise, f.octaves + layer.parts.first, layer.parts.count,
                         bound_placed(p, layer.low, layer.high, layer.scale, layer.bias),
                         layer.gradient_modulation != 0.0f);
  }
  if (layer.kind == FlatNoise::kSpots) return flat_bound_spots(f, layer, box);
  if (layer.kind == FlatNoise::kSparse) {
    return bound_sparse_heights(f.sparse_levels + layer.parts.first, layer.parts.count, layer.probability,
                                layer.inverse_probability, layer.amplitude, layer.level_cut, layer.sum_cut,
                                layer.height_bound, moved_into(box, layer.low, layer.high));
  }
  return {-layer.height_bound, layer.height_bound};
}

// Elevations after a layer's craters that reach the projected box.
ASTROLITH_HD inline Interval flat_bound_craters(const FlatField& f, const FlatNear& near,
                                                const FlatLayer& layer, const Box& projected,
                                                Interval elevation) {
  const FlatRange range = near.ranges[f.num_leaves + layer.list];
  for (std::uint32_t k = range.first; k < range.first + range.count; ++k) {
    const CraterKernel& crater = f.craters[layer.parts.first + near.numbers[k]];
    if (boxes_touch(crater_reach(crater), projected))
      elevation = bound_cratered(crater, projected, elevation);
  }
  return {clamped(elevation.low, -layer.height_bound, layer.height_bound),
          clamped(elevation.high, -layer.height_bound, layer.height_bound)};
}

ASTROLITH_HD inline Interval flat_bound_weight(const FlatField& f, const FlatJoin& join, const Box& box,
                                               const Interval* kept) {
  Interval weight{1.0, 1.0};
  if (join.local && join.locality.others.count != 0) {
    const auto nearest = [&](const FlatRange& r) {
      return bound_nearest(f.weight_spheres + r.first, r.count, box);
    };
    weight = bound_local_weight(nearest(join.locality.near), nearest(join.locality.others),
                                join.locality.inverse_width);
  }
  if (join.mask < 0) return weight;
  return product(weight, bound_mask(join.mask_from, join.mask_to, kept[join.mask]));
}

// Elevations over a box that all layers make.
ASTROLITH_HD inline Interval flat_bound_heights(const FlatField& f, const FlatNear& near, const Box& box,
                                                const Box& projected) {
  Interval elevation;
  Interval kept[kFlatSlots];
  for (std::uint32_t i = 0; i < f.num_layers; ++i) {
    const FlatLayer& layer = f.layers[i];
    if (layer.kind == FlatNoise::kCraters) {
      elevation = flat_bound_craters(f, near, layer, projected, elevation);
      continue;
    }
    const Interval heights = flat_bound_layer(f, layer, displaced_layer_box(box, layer.join.displaced));
    const double slack = kHeightSlack * layer.join.height_bound;
    if (layer.join.keeps >= 0) kept[layer.join.keeps] = plus(heights, {-slack, slack});
    if (!layer.join.changes_elevation) continue;
    elevation = bound_joined(layer.join.how, flat_bound_weight(f, layer.join, box, kept), elevation, heights);
  }
  const double slack = kHeightSlack * f.height_bound;
  return {elevation.low - slack, elevation.high + slack};
}

ASTROLITH_HD inline BlockContent flat_content_of_combined(const FlatField& f, const FlatNear& near,
                                                          const Box& box, KernelInterval* scratch) {
  const double height = f.height_bound * (1.0 + kHeightSlack);
  const Interval distance = flat_bound_distance(f, near, box, height, scratch);
  const BlockContent content = content_by_distance(distance, {-height, height});
  if (content != BlockContent::kMixed || f.num_layers == 0) return content;
  return content_by_distance(distance,
                             flat_bound_heights(f, near, box, projected_box(box, distance, height)));
}

ASTROLITH_HD inline BlockContent flat_content_of_plain(const FlatField& f, const FlatNear& near,
                                                       const Box& box, KernelInterval* scratch) {
  const Box at = flat_leaf_box(f, 0, box);
  const MetaballParameters<float>& body = f.leaves[0].body;
  const MetaballList spheres = near.metaballs(f, 0);
  const MetaballInterval bound = bound_metaballs(body, spheres, at, f.height_bound, scratch);
  const BlockContent content = content_by_height_bound(bound, f.height_bound);
  if (content != BlockContent::kMixed || f.num_layers == 0) return content;
  const auto divisor = [&] { return smallest_gradient(body, spheres, at, scratch); };
  const Box projected = f.boulder_list == 0 ? at : projected_box(at, bound, f.height_bound, divisor());
  return content_by_heights(bound, flat_bound_heights(f, near, box, projected), divisor);
}

// `scratch` takes as many as the longest list of metaballs is long.
ASTROLITH_HD inline BlockContent flat_content(const FlatField& f, const FlatNear& near, const Box& box,
                                              KernelInterval* scratch) {
  const BlockContent content = f.num_steps == 0 ? flat_content_of_plain(f, near, box, scratch)
                                                : flat_content_of_combined(f, near, box, scratch);
  const FlatRange boulders = near.ranges[f.num_leaves + f.boulder_list];
  for (std::uint32_t k = boulders.first;
       k < boulders.first + boulders.count && content == BlockContent::kOutside; ++k) {
    if (boulder_reaches(f, near.numbers[k], box)) return BlockContent::kMixed;
  }
  return content;
}

}  // namespace astrolith
