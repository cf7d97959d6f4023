// A recipe's field as plain arrays, and F at one point of it: one function for CPU and GPU, with the bits of
// ImplicitField. Made by flat_field_data.h from the same model. Evaluated one point at a time; the vectorised
// loops of ImplicitField are faster on a CPU.
#pragma once

#include <cstdint>
#include <limits>

#include "synthesis/fractal_noise.h"
#include "synthesis/layer_join.h"
#include "synthesis/metaball_body.h"
#include "synthesis/octave_sum.h"
#include "synthesis/sparse_noise.h"
#include "synthesis/spot_kernel.h"

namespace astrolith {

// Elements first .. first + count - 1 of an array.
struct FlatRange {
  std::uint32_t first = 0, count = 0;
};

// CoordinateWarp.
struct FlatWarp {
  FlatRange octaves[3];  // along x, y, z
  Vec3f low, high;       // points outside are displaced as the nearest one inside
};

// LocalWeight.
struct FlatWeight {
  FlatRange near, others;  // spheres
  float inverse_width = 0.0f;
};
struct FlatSphere {
  Vec3f center;
  float radius;
};

// The spots of one size. Their impulses are a block's list.
struct FlatSpots {
  SpotKernel kernel;
  float clip;
  std::uint32_t list;
};

enum class FlatNoise { kFractal, kSparse, kSpots };

// LayerJoin.
struct FlatJoin {
  float change_bound = 0.0f;  // by which this layer and those after it change an elevation at most
  bool changes_elevation = true, warps = false, blends = false, is_change = true;
  float sign = 1.0f, width = 0.0f;  // of a blend
  Vec3f direction;                  // of a warp
  bool local = false;
  FlatWeight locality;
  int keeps = -1, mask = -1;  // slots
  float mask_from = 0.0f, mask_inverse_range = 0.0f;
};

// Heights that masks ask for.
inline constexpr int kFlatSlots = 4;

// A layer; which members count depends on its noise. Points are moved into the box low .. high first.
struct FlatLayer {
  FlatNoise kind = FlatNoise::kFractal;
  FlatJoin join;
  Vec3f low, high;
  bool warped = false;
  FlatWarp warp;
  FlatRange parts;  // octaves, sparse levels or sizes of spots
  // Fractal noise.
  Noise noise = Noise::kSimplex;
  Vec3f scale, bias;
  float gradient_modulation = 0.0f;
  // Sparse noise.
  float amplitude = 0.0f, level_cut = 0.0f, sum_cut = 0.0f, probability = 0.0f, inverse_probability = 0.0f;
};

// Pointers to the arrays, which lie on the host or on a device, and what stands once.
struct FlatField {
  const FlatLayer* layers;
  const NoiseOctave* octaves;
  const FlatSphere* weight_spheres;
  const SparseLevel* sparse_levels;
  const FlatSpots* spots;
  std::uint32_t num_layers;
  MetaballParameters<float> body;
  bool warped;
  FlatWarp warp;       // of the body's coordinates
  float stretch;       // of that warp; 1 without
  float height_reach;  // no elevation exceeds it
};

// What of the field reaches a box.
struct FlatBlock {
  const MetaballSphere<float>* spheres;
  std::uint32_t num_spheres;
  const SpotImpulse* impulses;
  const std::uint32_t* first_impulse;  // of list l: first_impulse[l] .. first_impulse[l + 1] - 1
};

// Of many boxes, as arrays.
struct FlatBlocks {
  const MetaballSphere<float>* spheres;
  const std::uint32_t* first_sphere;  // (blocks + 1)
  const SpotImpulse* impulses;
  const std::uint32_t* first_impulse;  // (blocks * lists + 1)
  std::uint32_t lists;                 // of impulses, a block

  ASTROLITH_HD FlatBlock block(std::size_t i) const {
    return {spheres + first_sphere[i], first_sphere[i + 1] - first_sphere[i], impulses,
            first_impulse + i * lists};
  }
};

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

ASTROLITH_HD inline SurfaceDistance<float> flat_body(const FlatField& f, const FlatBlock& block,
                                                     const Vec3f& p) {
  MetaballSums<float> sums{};
  for (std::uint32_t j = 0; j < block.num_spheres; ++j) {
    accumulate_metaball(f.body, block.spheres[j], p, sums);
  }
  return metaball_distance(f.body, sums);
}

ASTROLITH_HD inline float flat_fractal(const FlatField& f, const FlatLayer& layer, const Vec3f& at) {
  const Vec3f p = layer.warped ? flat_warped(f, layer.warp, at) : at;
  const Vec3f q{placed_coordinate(p.x, layer.low.x, layer.high.x, layer.scale.x, layer.bias.x),
                placed_coordinate(p.y, layer.low.y, layer.high.y, layer.scale.y, layer.bias.y),
                placed_coordinate(p.z, layer.low.z, layer.high.z, layer.scale.z, layer.bias.z)};
  const std::uint32_t end = layer.parts.first + layer.parts.count;
  ModulatedSum sum{};
  for (std::uint32_t o = layer.parts.first; o < end; ++o) {
    if (layer.gradient_modulation == 0.0f) {
      sum.value = with_octave(layer.noise, f.octaves[o], q, sum.value);
    } else {
      sum = with_modulated_octave(layer.noise, f.octaves[o], layer.gradient_modulation, q, sum);
    }
  }
  return sum.value;
}

ASTROLITH_HD inline Vec3f flat_moved(const FlatLayer& layer, const Vec3f& p) {
  return {math::clamp(p.x, layer.low.x, layer.high.x), math::clamp(p.y, layer.low.y, layer.high.y),
          math::clamp(p.z, layer.low.z, layer.high.z)};
}

ASTROLITH_HD inline float flat_sparse(const FlatField& f, const FlatLayer& layer, const Vec3f& at) {
  const Vec3f p = flat_moved(layer, at);
  float sum = 0.0f;
  for (std::uint32_t l = layer.parts.first; l < layer.parts.first + layer.parts.count; ++l) {
    const SparseLevel& level = f.sparse_levels[l];
    const float noise = upscaled_noise(level.frequency * p.x, level.frequency * p.y, level.frequency * p.z,
                                       level.seed, layer.probability, layer.inverse_probability);
    sum = with_sparse_level(level.gain, noise, layer.level_cut, sum);
  }
  return sparse_height(layer.amplitude, sum, layer.sum_cut);
}

ASTROLITH_HD inline float flat_spots(const FlatField& f, const FlatLayer& layer, const FlatBlock& block,
                                     const Vec3f& at) {
  const Vec3f p = flat_moved(layer, at);
  float height = 0.0f;
  for (std::uint32_t s = layer.parts.first; s < layer.parts.first + layer.parts.count; ++s) {
    const FlatSpots& spots = f.spots[s];
    float sum = 0.0f;
    for (std::uint32_t j = block.first_impulse[spots.list]; j < block.first_impulse[spots.list + 1]; ++j) {
      sum += spot_height(spots.kernel, block.impulses[j], p.x, p.y, p.z);
    }
    height += math::clamp(sum, -spots.clip, spots.clip);
  }
  return height;
}

ASTROLITH_HD inline float flat_weight(const FlatField& f, const FlatWeight& weight, const Vec3f& p) {
  const auto distance = [&](const FlatRange& spheres) {
    float least = std::numeric_limits<float>::max();
    for (std::uint32_t s = spheres.first; s < spheres.first + spheres.count; ++s) {
      const FlatSphere& sphere = f.weight_spheres[s];
      least = nearer_sphere(sphere.center, sphere.radius, p.x, p.y, p.z, least);
    }
    return least;
  };
  if (weight.others.count == 0) return 1.0f;
  return local_weight(distance(weight.near), distance(weight.others), weight.inverse_width);
}

ASTROLITH_HD inline float flat_height(const FlatField& f, const FlatLayer& layer, const FlatBlock& block,
                                      const Vec3f& p) {
  return layer.kind == FlatNoise::kFractal  ? flat_fractal(f, layer, p)
         : layer.kind == FlatNoise::kSparse ? flat_sparse(f, layer, p)
                                            : flat_spots(f, layer, block, p);
}

// What the layers so far have made of the surface near a point.
struct FlatState {
  float elevation = 0.0f;
  bool is_displaced = false;
  Vec3f displacement;
  float kept[kFlatSlots] = {};
};

ASTROLITH_HD inline void flat_apply(const FlatField& f, const FlatLayer& layer, const FlatBlock& block,
                                    const Vec3f& p, FlatState& state) {
  const FlatJoin& join = layer.join;
  float height = flat_height(f, layer, block, state.is_displaced ? p + state.displacement : p);
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

// F(p) as FieldBlock::evaluate has it for the same band; `block` must hold what reaches p.
ASTROLITH_HD inline float flat_value(const FlatField& f, const FlatBlock& block, const Vec3f& p, float band) {
  if (f.warped) band *= f.stretch;
  const float distance = flat_body(f, block, f.warped ? flat_warped(f, f.warp, p) : p).distance;
  if (f.num_layers == 0 || math::abs(distance) > f.height_reach + band) return distance;
  FlatState state;
  for (std::uint32_t i = 0; i < f.num_layers; ++i) {
    if (math::abs(distance + state.elevation) > f.layers[i].join.change_bound + band) break;
    flat_apply(f, f.layers[i], block, p, state);
  }
  return distance + state.elevation;
}

}  // namespace astrolith
