// F at one point from a field's tables, for CPU and GPU, with the bits of ImplicitField.
//
// Functions with a Frame take ImplicitField::tables() and points of the body's frame, or
// ImplicitField::patch_tables() and points relative to the patch's centre.
#pragma once

#include "synthesis/body/body_at_point.h"
#include "synthesis/field/field_tables.h"
#include "synthesis/field/patch_place.h"

namespace astrolith {

// The most layers whose heights can be kept for masks at a time where a point is evaluated by itself. The
// functions here expect FieldView::num_kept_heights not to exceed it; obstacle_on_gpu()
// (cuda/mesher/gpu_mesher.h) checks.
inline constexpr std::uint32_t kMostKeptHeights = 16;

// The state of a point after the layers that were applied so far.
struct FieldState {
  float elevation = 0.0f;
  bool is_displaced = false;  // whether any layer warps the coordinates of the layers after it
  Vec3f displacement;
  float kept[kMostKeptHeights] = {};  // heights kept for masks, by slot
};

enum class Frame { kBody, kPatch };

// A point and the bare body there.
struct FieldPoint {
  Vec3f p;           // in the body's frame
  BodyAtPoint body;  // at p
  // p and body.at relative to the centre of the patch, in Frame::kPatch only.
  Vec3f local, local_at;
};

// The point of the frame's coordinates `given`.
template <Frame frame>
ASTROLITH_HD FieldPoint field_point(const FieldView& f, const BlockLists& lists, const Vec3f& given) {
  const Vec3f p = frame == Frame::kPatch ? rounded_in_body(f.patch.origin, given) : given;
  if (frame == Frame::kBody || !f.body.plain()) {
    return {p, body_at(f.body, f.arrays, lists.metaballs, p), given, given};
  }
  const BodyLeaf& leaf = f.leaf(0);
  const Vec3f at = leaf.warped ? warped(leaf.warp, f.arrays, p) : p;
  const Vec3f local_at =
      f.patch.warp.count != 0 ? warped(*f.arrays[f.patch.warp], f.arrays, given) : given + (at - p);
  BodyAtPoint body = local_plain_body_at(f.body, f.arrays, lists.metaballs, f.patch.origin, local_at);
  body.at = at;
  return {p, body, given, local_at};
}

// The projection of a point on the bare surface, in the body's frame or relative to the centre of the patch.
ASTROLITH_HD inline Vec3f projected_point(const FieldView& f, const FieldPoint& point, bool in_patch) {
  BodyAtPoint body = point.body;
  if (in_patch) body.at = point.local_at;
  return projected_point(body, f.leaf(0).metaballs.gradient_floor, f.longest_step);
}

// Joins a layer's height with the elevation that the layers before it made.
ASTROLITH_HD inline void join_height(const FieldView& f, const LayerJoin& join, const Vec3f& p, float height,
                                     FieldState& state) {
  if (join.keeps >= 0) state.kept[join.keeps] = height;
  float weight = 1.0f;
  if (join.mask >= 0) weight *= smooth_step(state.kept[join.mask], join.mask_from, join.mask_inverse_range);
  if (join.local) weight *= weight_at(join.locality, f.arrays, p);
  if (join.how.kind == Combine::kWarp) {
    const float by = join.weighted() ? weight * height : height;
    const Vec3f along = to_float(join.how.direction);
    Vec3f& d = state.displacement;
    d = {math::fma(along.x, by, d.x), math::fma(along.y, by, d.y), math::fma(along.z, by, d.z)};
    state.is_displaced = true;
  }
  if (join.changes_elevation()) state.elevation = join_elevation(join, weight, height, state.elevation);
}

// The noise of a layer in a frame.
template <Frame frame>
ASTROLITH_HD const LayerNoise& noise_in(const FieldView& f, const FieldLayer& layer) {
  return frame == Frame::kPatch ? f.noise(layer) : layer.noise;
}

// Visits a layer's noise_in() a frame: applies the layer at a point.
template <Frame frame>
struct LayerAtPoint {
  const FieldView& f;
  const BlockLists& lists;
  const FieldLayer& layer;
  const FieldPoint& point;
  FieldState& state;

  template <class Noise>
  ASTROLITH_HD void operator()(const Noise& noise) const {
    if constexpr (Noise::kTraits.has_heights) {
      join_height(f, layer.join, point.p, noise_height(noise), state);
    } else {
      change_elevation(noise);
    }
  }

 private:
  // Whether the noise is relative to the centre of the patch.
  ASTROLITH_HD bool in_patch() const { return frame == Frame::kPatch && layer.in_patch >= 0; }
  ASTROLITH_HD void change_elevation(const CraterRelief& relief) const {
    const std::uint32_t first = lists.first_landform[relief.list],
                        end = lists.first_landform[relief.list + 1];
    state.elevation = cratered_elevation(relief, f.arrays, lists.landforms + first, end - first,
                                         projected_point(f, point, in_patch()), state.elevation);
  }

  template <class Noise>
  ASTROLITH_HD float noise_height(const Noise& noise) const {
    const Vec3f at = noise_point(noise);
    if constexpr (Noise::kTraits.lists == NoiseLists::kSpots) {
      return height_at(noise, f.arrays, lists.spots, lists.first_spot + layer.first_list, at);
    } else if constexpr (Noise::kTraits.lists == NoiseLists::kGabor) {
      return height_at(noise, f.arrays, lists.gabor, lists.first_gabor + layer.first_list, at);
    } else {
      static_assert(Noise::kTraits.lists == NoiseLists::kNone);
      return height_at(noise, f.arrays, at);
    }
  }

  // The point where a noise is evaluated.
  template <class Noise>
  ASTROLITH_HD Vec3f noise_point(const Noise& noise) const {
    if constexpr (Noise::kTraits.on_surface) {
      return lifted(noise, projected_point(f, point, in_patch()));
    } else {
      const Vec3f& p = in_patch() ? point.local : point.p;
      return state.is_displaced ? p + state.displacement : p;
    }
  }
  template <class Noise>
  ASTROLITH_HD Vec3f lifted(const Noise& noise, const Vec3f& foot) const {
    if constexpr (Noise::kTraits.lifts) {
      if (noise.lifted) {
        return lifted_point(point.body, f.leaf(0).metaballs.gradient_floor, foot, state.elevation);
      }
    }
    return foot;
  }
};

// Whether a boulder that reaches the block may change F at the point.
ASTROLITH_HD inline bool boulders_reach(const FieldView& f, const BlockLists& lists, const Vec3f& p) {
  const FieldBoulder* boulders = f.arrays[f.boulders];
  const std::uint32_t* first = lists.first_landform + f.boulder_list();
  for (std::uint32_t k = first[0]; k < first[1]; ++k) {
    if (boulder_reaches(boulders[lists.landforms[k]], p.x, p.y, p.z)) return true;
  }
  return false;
}

// F without boulders. Layers are left out as soon as they and all layers after them cannot bring F into
// +-band. Where boulders reach, all layers are applied.
template <Frame frame>
ASTROLITH_HD float terrain_at(const FieldView& f, const BlockLists& lists, const FieldPoint& point,
                              float band) {
  const float distance = point.body.distance;
  const auto decided = [&](float value, float change) {
    return math::abs(value) > change + band && !boulders_reach(f, lists, point.p);
  };
  if (f.num_layers == 0 || decided(distance, f.height_reach)) return distance;
  FieldState state;
  for (std::uint32_t i = 0; i < f.num_layers; ++i) {
    const FieldLayer& layer = f.layers[i];
    if (decided(distance + state.elevation, layer.join.remaining_change)) break;
    if (layer.join.idle()) continue;
    noise_in<frame>(f, layer).visit(LayerAtPoint<frame>{f, lists, layer, point, state});
  }
  return distance + state.elevation;
}

// F of the union with the boulders that reach the block, where `value` is F without boulders.
template <Frame frame>
ASTROLITH_HD float with_boulders(const FieldView& f, const BlockLists& lists, const FieldPoint& point,
                                 float value) {
  const FieldBoulder* boulders = f.arrays[f.boulders];
  const std::uint32_t* first = lists.first_landform + f.boulder_list();
  for (std::uint32_t k = first[0]; k < first[1]; ++k) {
    const FieldBoulder& boulder = boulders[lists.landforms[k]];
    const Vec3f& p = frame == Frame::kPatch && boulder.in_patch ? point.local : point.p;
    if (is_within_reach(boulder.kernel, p.x, p.y, p.z)) {
      value = join_boulder(boulder.kernel, p.x, p.y, p.z, value);
    }
  }
  return value;
}

// F(p) with the bits of FieldBlock::evaluate, or of evaluate_local in Frame::kPatch, for the same band
// (length units). `lists` must hold all elements that reach p.
template <Frame frame = Frame::kBody>
ASTROLITH_HD float field_at(const FieldView& f, const BlockLists& lists, const Vec3f& p, float band) {
  const FieldPoint point = field_point<frame>(f, lists, p);
  return with_boulders<frame>(f, lists, point, terrain_at<frame>(f, lists, point, band * f.steepest));
}

// Visits a layer's noise_in() a frame: applies the layer at the four corners of a tetrahedron.
template <Frame frame>
struct LayerAtTetrahedron {
  const FieldView& f;
  const BlockLists& lists;
  const FieldLayer& layer;
  const FieldPoint* point;
  FieldState* state;

  template <class Noise>
  ASTROLITH_HD void operator()(const Noise& noise) const {
    if constexpr (Noise::kTraits.lists == NoiseLists::kGabor) {
      join_gabor(noise);
    } else {
      for (int k = 0; k < 4; ++k) LayerAtPoint<frame>{f, lists, layer, point[k], state[k]}(noise);
    }
  }

 private:
  template <class GaborNoise>
  ASTROLITH_HD void join_gabor(const GaborNoise& noise) const {
    Vec3f projected[4];
    float heights[4];
    const bool in_patch = frame == Frame::kPatch && layer.in_patch >= 0;
    for (int k = 0; k < 4; ++k) projected[k] = projected_point(f, point[k], in_patch);
    tetrahedron_heights(noise, f.arrays, lists.gabor, lists.first_gabor + layer.first_list, projected,
                        heights);
    for (int k = 0; k < 4; ++k) join_height(f, layer.join, point[k].p, heights[k], state[k]);
  }
};

// F at the four corners p of a small tetrahedron, with the bits of FieldBlock::evaluate_tetrahedra, or of
// evaluate_local_tetrahedra in Frame::kPatch.
template <Frame frame = Frame::kBody>
ASTROLITH_HD void field_at_tetrahedron(const FieldView& f, const BlockLists& lists, const Vec3f* p,
                                       float* values) {
  FieldPoint point[4];
  FieldState state[4];
  for (int k = 0; k < 4; ++k) point[k] = field_point<frame>(f, lists, p[k]);
  for (std::uint32_t i = 0; i < f.num_layers; ++i) {
    const FieldLayer& layer = f.layers[i];
    if (layer.join.idle()) continue;
    noise_in<frame>(f, layer).visit(LayerAtTetrahedron<frame>{f, lists, layer, point, state});
  }
  for (int k = 0; k < 4; ++k) {
    values[k] = with_boulders<frame>(f, lists, point[k], point[k].body.distance + state[k].elevation);
  }
}

}  // namespace astrolith
