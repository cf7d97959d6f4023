// F of a flat field at one point: one function for CPU and GPU, with the bits of ImplicitField.
#pragma once

#include "synthesis/field/flat_layers.h"
#include "synthesis/field/layer_join.h"

namespace astrolith {

// What the layers so far have made of the surface near a point.
struct FlatState {
  float elevation = 0.0f;
  bool is_displaced = false;
  Vec3f displacement;
  float kept[kFlatSlots] = {};
};

// Where a layer of noise in space is evaluated for a point.
ASTROLITH_HD inline Vec3f flat_displaced(const FlatState& state, const Vec3f& p) {
  return state.is_displaced ? p + state.displacement : p;
}

// Joins a layer's height with what is there.
ASTROLITH_HD inline void flat_join(const FlatField& f, const FlatLayer& layer, const Vec3f& p, float height,
                                   FlatState& state) {
  const FlatJoin& join = layer.join;
  if (join.keeps >= 0) state.kept[join.keeps] = height;
  const bool weighted = join.local || join.mask >= 0;
  float weight = 1.0f;
  if (join.mask >= 0) weight *= smooth_step(state.kept[join.mask], join.mask_from, join.mask_inverse_range);
  if (join.local) weight *= flat_weight(f, join.locality, p);
  if (join.warps) {
    const float by = weighted ? weight * height : height;
    Vec3f& d = state.displacement;
    d = {math::fma(join.direction.x, by, d.x), math::fma(join.direction.y, by, d.y),
         math::fma(join.direction.z, by, d.z)};
    state.is_displaced = true;
  }
  if (!join.changes_elevation) return;
  if (join.blends) height = blended_height(join.sign, join.width, state.elevation, height);
  state.elevation = weighted ? joined_elevation(join.is_change, weight, height, state.elevation)
                             : joined_elevation(join.is_change, height, state.elevation);
}

ASTROLITH_HD inline void flat_apply(const FlatField& f, const FlatLayer& layer, const FlatBlock& block,
                                    const FlatBodySample& body, const Vec3f& p, FlatState& state) {
  if (layer.kind == FlatNoise::kCraters) {
    state.elevation = flat_cratered(f, layer, block, flat_projected(f, body), state.elevation);
  } else if (layer.kind == FlatNoise::kGabor) {
    flat_join(f, layer, p, flat_gabor(f, layer, block, flat_projected(f, body)), state);
  } else {
    flat_join(f, layer, p, flat_height(f, layer, block, flat_displaced(state, p)), state);
  }
}

// Whether a boulder that reaches the block may change F at the point.
ASTROLITH_HD inline bool flat_boulders_reach(const FlatField& f, const FlatBlock& block, const Vec3f& p) {
  const auto within = [](float c, double low, double high) { return double{c} >= low && double{c} <= high; };
  for (std::uint32_t k = block.first_landform[f.boulder_list]; k < block.first_landform[f.boulder_list + 1];
       ++k) {
    const FlatBoulder& b = f.boulders[block.landforms[k]];
    if (within(p.x, b.low.x, b.high.x) && within(p.y, b.low.y, b.high.y) && within(p.z, b.low.z, b.high.z)) {
      return true;
    }
  }
  return false;
}

// Without boulders. Layers are added until those to come cannot bring F into the band, but wherever boulders
// reach.
ASTROLITH_HD inline float flat_terrain(const FlatField& f, const FlatBlock& block, const Vec3f& p,
                                       float band) {
  const FlatBodySample body = flat_body(f, block, p);
  const auto decided = [&](float value, float change) {
    return math::abs(value) > change + band && !flat_boulders_reach(f, block, p);
  };
  if (f.num_layers == 0 || decided(body.distance, f.height_reach)) return body.distance;
  FlatState state;
  for (std::uint32_t i = 0; i < f.num_layers; ++i) {
    if (decided(body.distance + state.elevation, f.layers[i].join.change_bound)) break;
    flat_apply(f, f.layers[i], block, body, p, state);
  }
  return body.distance + state.elevation;
}

ASTROLITH_HD inline float flat_with_boulders(const FlatField& f, const FlatBlock& block, const Vec3f& p,
                                             float value) {
  for (std::uint32_t k = block.first_landform[f.boulder_list]; k < block.first_landform[f.boulder_list + 1];
       ++k) {
    value = join_boulder(f.boulders[block.landforms[k]].kernel, p.x, p.y, p.z, value);
  }
  return value;
}

// F(p) as FieldBlock::evaluate has it for the same band; `block` must hold what reaches p.
ASTROLITH_HD inline float flat_value(const FlatField& f, const FlatBlock& block, const Vec3f& p, float band) {
  return flat_with_boulders(f, block, p, flat_terrain(f, block, p, band * f.lipschitz_bound));
}

// F at the corners of a small tetrahedron, as FieldBlock::evaluate_tetrahedra has it.
ASTROLITH_HD inline void flat_tetrahedron(const FlatField& f, const FlatBlock& block, const Vec3f* p,
                                          float* values) {
  FlatBodySample body[4];
  FlatState state[4];
  for (int k = 0; k < 4; ++k) body[k] = flat_body(f, block, p[k]);
  for (std::uint32_t i = 0; i < f.num_layers; ++i) {
    const FlatLayer& layer = f.layers[i];
    if (layer.kind != FlatNoise::kGabor) {
      for (int k = 0; k < 4; ++k) flat_apply(f, layer, block, body[k], p[k], state[k]);
      continue;
    }
    Vec3f projected[4];
    float heights[4];
    for (int k = 0; k < 4; ++k) projected[k] = flat_projected(f, body[k]);
    flat_gabor_tetrahedron(f, layer, block, projected, heights);
    for (int k = 0; k < 4; ++k) flat_join(f, layer, p[k], heights[k], state[k]);
  }
  for (int k = 0; k < 4; ++k) {
    values[k] = flat_with_boulders(f, block, p[k], body[k].distance + state[k].elevation);
  }
}

}  // namespace astrolith
