// F at one point from a field's tables, for CPU and GPU, with the bits of ImplicitField.
#pragma once

#include "synthesis/body/body_at_point.h"
#include "synthesis/field/field_tables.h"

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

// The projection of a point on the bare surface.
ASTROLITH_HD inline Vec3f projected_point(const FieldView& f, const BodyAtPoint& body) {
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

// Visits a layer's noise: applies the layer at a point.
struct LayerAtPoint {
  const FieldView& f;
  const BlockLists& lists;
  const FieldLayer& layer;
  const BodyAtPoint& body;
  const Vec3f& p;
  FieldState& state;

  template <class Noise>
  ASTROLITH_HD void operator()(const Noise& noise) const {
    if constexpr (Noise::kTraits.has_heights) {
      join_height(f, layer.join, p, height_of(noise), state);
    } else {
      change_elevation(noise);
    }
  }

 private:
  ASTROLITH_HD void change_elevation(const CraterRelief& relief) const {
    const std::uint32_t first = lists.first_landform[relief.list],
                        end = lists.first_landform[relief.list + 1];
    state.elevation = cratered_elevation(relief, f.arrays, lists.landforms + first, end - first,
                                         projected_point(f, body), state.elevation);
  }

  template <class Noise>
  ASTROLITH_HD float height_of(const Noise& noise) const {
    const Vec3f at = place_of(noise);
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
  ASTROLITH_HD Vec3f place_of(const Noise& noise) const {
    if constexpr (Noise::kTraits.on_surface) {
      return lifted(noise, projected_point(f, body));
    } else {
      return state.is_displaced ? p + state.displacement : p;
    }
  }
  template <class Noise>
  ASTROLITH_HD Vec3f lifted(const Noise& noise, const Vec3f& foot) const {
    if constexpr (Noise::kTraits.lifts) {
      if (noise.lifted) return lifted_point(body, f.leaf(0).metaballs.gradient_floor, foot, state.elevation);
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
ASTROLITH_HD inline float terrain_at(const FieldView& f, const BlockLists& lists, const Vec3f& p,
                                     float band) {
  const BodyAtPoint body = body_at(f.body, f.arrays, lists.metaballs, p);
  const auto decided = [&](float value, float change) {
    return math::abs(value) > change + band && !boulders_reach(f, lists, p);
  };
  if (f.num_layers == 0 || decided(body.distance, f.height_reach)) return body.distance;
  FieldState state;
  for (std::uint32_t i = 0; i < f.num_layers; ++i) {
    const FieldLayer& layer = f.layers[i];
    if (decided(body.distance + state.elevation, layer.join.remaining_change)) break;
    if (layer.join.idle()) continue;
    layer.noise.visit(LayerAtPoint{f, lists, layer, body, p, state});
  }
  return body.distance + state.elevation;
}

// F of the union with the boulders that reach the block, where `value` is F without boulders.
ASTROLITH_HD inline float with_boulders(const FieldView& f, const BlockLists& lists, const Vec3f& p,
                                        float value) {
  const FieldBoulder* boulders = f.arrays[f.boulders];
  const std::uint32_t* first = lists.first_landform + f.boulder_list();
  for (std::uint32_t k = first[0]; k < first[1]; ++k) {
    value = join_boulder(boulders[lists.landforms[k]].kernel, p.x, p.y, p.z, value);
  }
  return value;
}

// F(p) with the bits of FieldBlock::evaluate for the same band (length units). `lists` must hold all elements
// that reach p.
ASTROLITH_HD inline float field_at(const FieldView& f, const BlockLists& lists, const Vec3f& p, float band) {
  return with_boulders(f, lists, p, terrain_at(f, lists, p, band * f.steepest));
}

// Visits a layer's noise: applies the layer at the four corners of a tetrahedron.
struct LayerAtTetrahedron {
  const FieldView& f;
  const BlockLists& lists;
  const FieldLayer& layer;
  const BodyAtPoint* body;
  const Vec3f* p;
  FieldState* state;

  template <class Noise>
  ASTROLITH_HD void operator()(const Noise& noise) const {
    if constexpr (Noise::kTraits.lists == NoiseLists::kGabor) {
      join_gabor(noise);
    } else {
      for (int k = 0; k < 4; ++k) LayerAtPoint{f, lists, layer, body[k], p[k], state[k]}(noise);
    }
  }

 private:
  template <class GaborNoise>
  ASTROLITH_HD void join_gabor(const GaborNoise& noise) const {
    Vec3f projected[4];
    float heights[4];
    for (int k = 0; k < 4; ++k) projected[k] = projected_point(f, body[k]);
    tetrahedron_heights(noise, f.arrays, lists.gabor, lists.first_gabor + layer.first_list, projected,
                        heights);
    for (int k = 0; k < 4; ++k) join_height(f, layer.join, p[k], heights[k], state[k]);
  }
};

// F at the four corners p of a small tetrahedron, with the bits of FieldBlock::evaluate_tetrahedra.
ASTROLITH_HD inline void field_at_tetrahedron(const FieldView& f, const BlockLists& lists, const Vec3f* p,
                                              float* values) {
  BodyAtPoint body[4];
  FieldState state[4];
  for (int k = 0; k < 4; ++k) body[k] = body_at(f.body, f.arrays, lists.metaballs, p[k]);
  for (std::uint32_t i = 0; i < f.num_layers; ++i) {
    const FieldLayer& layer = f.layers[i];
    if (layer.join.idle()) continue;
    layer.noise.visit(LayerAtTetrahedron{f, lists, layer, body, p, state});
  }
  for (int k = 0; k < 4; ++k) {
    values[k] = with_boulders(f, lists, p[k], body[k].distance + state[k].elevation);
  }
}

}  // namespace astrolith
