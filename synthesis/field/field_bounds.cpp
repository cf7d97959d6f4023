// Bounds of a field over boxes, on the CPU.
#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "synthesis/body/level_expansion.h"
#include "synthesis/field/field_content.h"
#include "synthesis/field/field_model_internal.h"

namespace astrolith {
namespace {

// The `Lists` of field_content.h, found with the search structures of the model.
struct ModelLists {
  const FieldModel& model;
  const ReachingMetaballs& reaching;
  const DrawnSpots& spots;

  MetaballList metaballs(std::uint32_t leaf) const {
    const std::uint32_t first = reaching.first[leaf];
    return {reaching.spheres.data() + first, nullptr, reaching.first[leaf + 1] - first};
  }
  Interval bound_spots(const SpotNoise& noise, std::uint32_t layer, const Box& box) const {
    return bound_heights(noise, model.tables.arrays, box, find_spots(spots, layer));
  }
  template <class Visit>
  void for_each_crater(const CraterRelief& relief, const Box& box, const Visit& visit) const {
    for (const std::uint32_t number : model.crater_trees[relief.list].touching(box)) visit(number);
  }
  bool boulder_reaches(const Box& box) const { return model.boulder_tree.any_touching(box); }
};

// The lists of a box that no metaball reaches.
struct NoMetaballs {
  MetaballList metaballs(std::uint32_t) const { return {nullptr, nullptr, 0}; }
};

// Scratch memory for the bounds of one box. It is reused, since thousands of boxes are bounded.
BoundScratch scratch_for(const FieldModel& model, const ReachingMetaballs& metaballs) {
  thread_local std::vector<KernelInterval> kernels;
  thread_local std::vector<Interval> kept;
  kernels.resize(std::max(kernels.size(), metaballs.spheres.size()));
  kept.assign(model.num_kept_heights, {});
  return {kernels.data(), kept.data()};
}

// The content of a box by the bound of all heights everywhere, without evaluating a layer. `at` is the
// body_box() of the box.
BlockContent content_by_height_bound(const FieldModel& model, const ReachingMetaballs& metaballs,
                                     const Box& at) {
  const FieldView& f = model.tables;
  const ModelLists lists{model, metaballs, {}};
  KernelInterval* scratch = scratch_for(model, metaballs).kernels;
  if (f.body.plain()) {
    constexpr double kEverywhere = std::numeric_limits<double>::infinity();
    return content_by_height_bound(
        bound_metaballs(f.leaf(0).metaballs, lists.metaballs(0), at, kEverywhere, scratch),
        model.height_bound);
  }
  const double height = model.height_bound * (1.0 + kHeightSlack);
  return content_by_distance(bound_distance(f.body, f.arrays, lists, at, height, scratch), {-height, height});
}

std::array<Box, 8> octants(const Box& box) {
  const Vec3d c = box.center();
  std::array<Box, 8> children;
  for (unsigned k = 0; k < 8; ++k) {
    Box& child = children[k];
    child.min = {k & 1 ? c.x : box.min.x, k & 2 ? c.y : box.min.y, k & 4 ? c.z : box.min.z};
    child.max = {k & 1 ? box.max.x : c.x, k & 2 ? box.max.y : c.y, k & 4 ? box.max.z : c.z};
  }
  return children;
}

bool within(const Box& inner, const Box& outer) {
  return inner.min.x >= outer.min.x && inner.min.y >= outer.min.y && inner.min.z >= outer.min.z &&
         inner.max.x <= outer.max.x && inner.max.y <= outer.max.y && inner.max.z <= outer.max.z;
}

// Extends `bounds` by the smallest boxes of an octree that are not proved empty. The grid of a mesh follows
// from the bounds, so this function must never give others for the same recipe.
void extend_bounds(const FieldModel& model, const LeafLists& metaballs, const Box& box, int depth,
                   Box& bounds) {
  if (!bounds.empty() && within(box, bounds)) return;
  const FieldView& f = model.tables;
  const Box at = body_box(f.body, f.arrays, box);
  const ReachingMetaballs reaching = metaballs_reaching(f.body, f.arrays, metaballs, at);
  const BlockContent content = content_by_height_bound(model, reaching, at);
  if (content == BlockContent::kOutside) return;
  if (depth == 0 || content == BlockContent::kInside) {
    bounds.extend(box.min);
    bounds.extend(box.max);
    return;
  }
  for (const Box& child : octants(box)) extend_bounds(model, reaching.lists(), child, depth - 1, bounds);
}

// What both of these say of the same box.
ExpansionBounds both(const ExpansionBounds& a, const MetaballInterval& b) {
  return {{std::max(a.interval.level_min, b.level_min), std::min(a.interval.level_max, b.level_max),
           std::min(a.interval.gradient_max, b.gradient_max)},
          a.divisor_min,
          a.tight};
}

// The content of a box, without boulders, for a plain body without a warp. It is found from an expansion
// about the centre of the box, and from the bounds of each metaball where these may be better.
std::optional<BlockContent> content_by_expansion(const FieldModel& model, const ModelLists& lists,
                                                 const Box& box, const BoundScratch& scratch) {
  const FieldView& f = model.tables;
  if (!f.body.plain() || f.leaf(0).warped) return {};
  const MetaballsView metaballs{f.leaf(0).metaballs, lists.reaching.spheres};
  const std::optional<LevelExpansion> expansion = expand_level(metaballs, box);
  if (!expansion) return {};
  ExpansionBounds bounds = bound_expansion(*expansion, metaballs.parameters, box);
  if (!bounds.tight) {
    bounds = both(bounds, bound_metaballs(metaballs.parameters, lists.metaballs(0), box, f.height_bound,
                                          scratch.kernels));
  }
  const BlockContent content = content_by_height_bound(bounds.interval, f.height_bound);
  if (content != BlockContent::kMixed || f.num_layers == 0) return content;
  const double longest_step = f.height_bound * (1.0 + kHeightSlack);
  const Box projected = projected_box(*expansion, bounds, metaballs.parameters, box, longest_step);
  return content_by_heights(bounds.interval, bound_elevations(f, lists, box, projected, scratch.kept),
                            [&] { return bounds.divisor_min; });
}

}  // namespace

const LayerNoise& find_noise(const FieldModel& model, const FieldLayer& layer) {
  return layer.in_patch < 0 ? layer.noise : model.patch_noises[static_cast<std::size_t>(layer.in_patch)];
}

BlockContent block_content(const FieldModel& model, const ReachingMetaballs& metaballs,
                           const DrawnSpots& spots, const Box& box) {
  const ModelLists lists{model, metaballs, spots};
  const BoundScratch scratch = scratch_for(model, metaballs);
  const std::optional<BlockContent> content = content_by_expansion(model, lists, box, scratch);
  if (!content) return field_content(model.tables, lists, box, scratch);
  return with_boulders(*content, lists, box);
}

Interval elevations_over(const FieldModel& model, const DrawnSpots& spots, const Box& box,
                         const Box& projected) {
  const ReachingMetaballs no_metaballs;  // only the bounds of the body read them
  return bound_elevations(model.tables, ModelLists{model, no_metaballs, spots}, box, projected,
                          scratch_for(model, no_metaballs).kept);
}

DrawnSpots spots_reaching(const FieldModel& model, const Box& box, const DrawnSpots& larger_box_spots) {
  DrawnSpots spots;
  for (std::size_t i = 0; i < model.layers.size(); ++i) {
    const FieldLayer& layer = model.layers[i];
    const SpotNoise* noise = find_noise(model, layer).get_if<SpotNoise>();
    if (noise == nullptr) continue;
    const Box at = model.tables.in_layer_frame(layer, box);
    spots.resize(model.layers.size());
    spots[i] = gather_spots(*noise, model.tables.arrays, displaced_layer_box(at, layer.join.displaced),
                            find_spots(larger_box_spots, i));
  }
  return spots;
}

double height_limit(const FieldModel& model) {
  constexpr double kAnyHeight = std::numeric_limits<double>::infinity();
  constexpr double kSlack = 1e-4;  // the rounding of heights, of s and of their sum
  const FieldView& f = model.tables;
  const Box anywhere{{0, 0, 0}, {0, 0, 0}};
  if (f.body.plain()) {
    const MetaballInterval beyond =
        bound_metaballs(f.leaf(0).metaballs, NoMetaballs{}.metaballs(0), anywhere, kAnyHeight, nullptr);
    return -(1.0 - kSlack) * beyond.level_max / beyond.gradient_max;
  }
  // Beyond the domains of all grids.
  const Vec3d far = f.body.supports.max + f.body.supports.extent();
  const Interval beyond = bound_distance(f.body, f.arrays, NoMetaballs{}, {far, far}, kAnyHeight, nullptr);
  return beyond.high < 0.0 ? -(1.0 - kSlack) * beyond.high : 0.0;
}

// The supports reach far beyond the surface. The octree is therefore built again on the box that is left,
// until the box stops shrinking much.
Box surface_bounds(const FieldModel& model) {
  constexpr int kDepth = 6;
  const BodyLeaf& first = model.tables.leaf(0);
  Box box = model.body.supports;
  if (model.body.plain() && first.warped) box = widened(box, first.warp.bound);
  if (model.body.gridded) box = widened(box, model.height_bound);
  for (int pass = 0; pass < 4; ++pass) {
    Box tighter;
    extend_bounds(model, model.metaballs.lists(), box, kDepth, tighter);
    if (tighter.empty()) return tighter;
    const bool shrunk = norm(tighter.extent()) < 0.7 * norm(box.extent());
    box = tighter;
    if (!shrunk) break;
  }
  if (!model.boulders.empty()) {
    box.extend(model.boulder_tree.bounds().min);
    box.extend(model.boulder_tree.bounds().max);
  }
  return box;
}

}  // namespace astrolith
