// Bounds of a field over a box, and whether the field keeps one sign there. CPU and GPU find the same bits.
//
// A type `Lists` tells which elements of the field reach the box:
//   MetaballList metaballs(leaf)                  the metaballs of a leaf that reach leaf_box() of the box
//   Interval bound_spots(noise, layer, box)       bounds of the heights of a layer of spots over a box
//   for_each_crater(relief, box, visit)           visit(number) for each crater that reaches it, ascending
//   bool boulder_reaches(box)                     whether any boulder reaches a box
#pragma once

#include "synthesis/body/body_bounds.h"
#include "synthesis/field/content_bounds.h"
#include "synthesis/field/field_tables.h"

namespace astrolith {

// Bounds of a layer's weight over a box, within [0, 1]. `kept` holds bounds of the heights kept for masks, by
// slot.
ASTROLITH_HD inline Interval bound_join_weight(const FieldView& f, const LayerJoin& join, const Box& box,
                                               const Interval* kept) {
  const Interval local = join.local ? bound_weight(join.locality, f.arrays, box) : Interval{1.0, 1.0};
  return join.mask < 0 ? local : product(local, bound_mask(join.mask_from, join.mask_to, kept[join.mask]));
}

// Visits a layer's noise: bounds the elevations over a box after the layer, from the bounds before it.
template <class Lists>
struct LayerOverBox {
  const FieldView& f;
  const Lists& lists;
  std::uint32_t number;
  const Box& box;
  const Box& projected;  // holds the projections of the points of the box on the bare surface
  Interval before;
  Interval* kept;  // bounds of the heights kept for masks, by slot

  template <class Noise>
  ASTROLITH_HD Interval operator()(const Noise& noise) const {
    if constexpr (Noise::kTraits.has_heights) {
      return joined(bound_noise(noise));
    } else {
      return changed_elevation(noise);
    }
  }

 private:
  ASTROLITH_HD const FieldLayer& layer() const { return f.layers[number]; }
  ASTROLITH_HD const LayerJoin& join() const { return layer().join; }
  ASTROLITH_HD Interval changed_elevation(const CraterRelief& relief) const {
    const auto for_each = [&](const auto& visit) { lists.for_each_crater(relief, projected, visit); };
    return bound_cratered_elevation(relief, f.arrays, for_each, f.in_layer_frame(layer(), projected), before);
  }
  template <class Noise>
  ASTROLITH_HD Interval bound_noise(const Noise& noise) const {
    if constexpr (Noise::kTraits.lists == NoiseLists::kSpots) {
      return lists.bound_spots(noise, number, noise_box<Noise>());
    } else {
      return bound_heights(noise, f.arrays, noise_box<Noise>());
    }
  }
  // Holds the places where a noise is evaluated for the points of the box, in the coordinates of the noise.
  template <class Noise>
  ASTROLITH_HD Box noise_box() const {
    if constexpr (Noise::kTraits.on_surface) {
      return f.in_layer_frame(layer(), projected);
    } else {
      return displaced_layer_box(f.in_layer_frame(layer(), box), join().displaced);
    }
  }
  ASTROLITH_HD Interval joined(const Interval& heights) const {
    const double slack = kHeightSlack * join().height_bound;
    if (join().keeps >= 0) kept[join().keeps] = plus(heights, {-slack, slack});
    if (!join().changes_elevation()) return before;
    return join_bounds(join().how, bound_join_weight(f, join(), box, kept), before, heights);
  }
};

// Bounds of the elevations that all layers make over a box. `kept` has room for f.num_kept_heights intervals.
template <class Lists>
ASTROLITH_HD Interval bound_elevations(const FieldView& f, const Lists& lists, const Box& box,
                                       const Box& projected, Interval* kept) {
  Interval elevation;
  for (std::uint32_t i = 0; i < f.num_layers; ++i) {
    elevation = f.noise(f.layers[i]).visit(LayerOverBox<Lists>{f, lists, i, box, projected, elevation, kept});
  }
  const double slack = kHeightSlack * f.height_bound;
  return {elevation.low - slack, elevation.high + slack};
}

// Scratch memory for the bounds of one box; both arrays belong to the caller.
struct BoundScratch {
  KernelInterval* kernels;  // (length of the longest list of metaballs)
  Interval* kept;           // (f.num_kept_heights)
};

// The content of a box, without boulders, for a body with operations.
template <class Lists>
ASTROLITH_HD BlockContent combined_content(const FieldView& f, const Lists& lists, const Box& box,
                                           const BoundScratch& scratch) {
  const double height = f.height_bound * (1.0 + kHeightSlack);
  const Interval distance = bound_distance(f.body, f.arrays, lists, box, height, scratch.kernels);
  const BlockContent content = content_by_distance(distance, {-height, height});
  if (content != BlockContent::kMixed || f.num_layers == 0) return content;
  const Box projected = projected_box(box, distance, height);
  return content_by_distance(distance, bound_elevations(f, lists, box, projected, scratch.kept));
}

// The content of a box, without boulders, for a plain body.
template <class Lists>
ASTROLITH_HD BlockContent plain_content(const FieldView& f, const Lists& lists, const Box& box,
                                        const BoundScratch& scratch) {
  const Box at = body_box(f.body, f.arrays, box);
  const MetaballParameters<float>& leaf = f.leaf(0).metaballs;
  const MetaballList spheres = lists.metaballs(0);
  const MetaballInterval bound = bound_metaballs(leaf, spheres, at, f.height_bound, scratch.kernels);
  const BlockContent content = content_by_height_bound(bound, f.height_bound);
  if (content != BlockContent::kMixed || f.num_layers == 0) return content;
  const auto divisor = [&] { return smallest_gradient(leaf, spheres, at, scratch.kernels); };
  const Box projected = f.reads_projections ? projected_box(at, bound, f.height_bound, divisor()) : at;
  return content_by_heights(bound, bound_elevations(f, lists, box, projected, scratch.kept), divisor);
}

// The content of a box with boulders, from that without. Boulders only add matter, so they can make a box
// mixed that lies outside the rest of the body, and never one that lies inside.
template <class Lists>
ASTROLITH_HD BlockContent with_boulders(BlockContent content, const Lists& lists, const Box& box) {
  return content == BlockContent::kOutside && lists.boulder_reaches(box) ? BlockContent::kMixed : content;
}

// Whether F keeps one sign over the box.
template <class Lists>
ASTROLITH_HD BlockContent field_content(const FieldView& f, const Lists& lists, const Box& box,
                                        const BoundScratch& scratch) {
  return with_boulders(
      f.body.plain() ? plain_content(f, lists, box, scratch) : combined_content(f, lists, box, scratch),
      lists, box);
}

}  // namespace astrolith
