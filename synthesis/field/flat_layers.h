// The layers of a flat field at one point, with the bits of their vectorised loops.
#pragma once

#include <limits>

#include "synthesis/field/flat_body.h"
#include "synthesis/field/local_weight.h"

namespace astrolith {

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
      sum += spot_height(spots.kind.kernel, block.impulses[j], p.x, p.y, p.z);
    }
    height += math::clamp(sum, -spots.kind.clip, spots.kind.clip);
  }
  return height;
}

ASTROLITH_HD inline float flat_phasor(const FlatLayer& layer, const Vec3f& at) {
  const Vec3f p = flat_moved(layer, at);
  const float x = p.x * layer.inverse_cell, y = p.y * layer.inverse_cell, z = p.z * layer.inverse_cell;
  PhasorSum sum{};
  for (int c = 0; c < 27; ++c) {
    const Vec3f cell = phasor_cell(c);
    for (int j = 0; j < static_cast<int>(layer.parts.count); ++j) {
      sum = with_phasor_impulse(layer.kernels, cell.x, cell.y, cell.z, phasor_seed(layer.seed, j), x, y, z,
                                sum);
    }
  }
  return layer.amplitude * phasor_profile(layer.profile, math::atan2_turns(sum.imaginary, sum.real));
}

ASTROLITH_HD inline float flat_random_phase(const FlatField& f, const FlatLayer& layer, const Vec3f& at) {
  const Vec3f p = flat_moved(layer, at);
  PhaseCorner corners[8];
  float weights = 0.0f;
  for (unsigned c = 0; c < 8; ++c) {
    corners[c] = phase_corner(c, p.x * layer.inverse_cell, p.y * layer.inverse_cell, p.z * layer.inverse_cell,
                              layer.seed);
    weights += corners[c].weight;
  }
  float height = 0.0f;
  for (std::uint32_t w = layer.parts.first; w < layer.parts.first + layer.parts.count; ++w) {
    for (const PhaseCorner& corner : corners) {
      height = with_wave(f.waves[w], layer.randomness, corner, p.x, p.y, p.z, height);
    }
  }
  return math::clamp(height * phase_scale(layer.coherence, weights), -layer.clip, layer.clip);
}

// At a point of the bare surface.
ASTROLITH_HD inline float flat_gabor(const FlatField& f, const FlatLayer& layer, const FlatBlock& block,
                                     const Vec3f& at) {
  const Vec3f p = flat_moved(layer, at);
  float height = 0.0f;
  for (std::uint32_t b = layer.parts.first; b < layer.parts.first + layer.parts.count; ++b) {
    const float amplitude = f.bands[b].draw.amplitude;
    for (std::uint32_t j = block.first_gabor[b]; j < block.first_gabor[b + 1]; ++j) {
      height = math::fma(amplitude, gabor_kernel(block.gabor[j], p.x, p.y, p.z), height);
    }
  }
  return math::clamp(height, -layer.clip, layer.clip);
}

// At four, to first order about their centre.
ASTROLITH_HD inline void flat_gabor_tetrahedron(const FlatField& f, const FlatLayer& layer,
                                                const FlatBlock& block, const Vec3f* p, float* heights) {
  const Vec3f center{tetrahedron_center(p[0].x, p[1].x, p[2].x, p[3].x),
                     tetrahedron_center(p[0].y, p[1].y, p[2].y, p[3].y),
                     tetrahedron_center(p[0].z, p[1].z, p[2].z, p[3].z)};
  const Vec3f q = flat_moved(layer, center);
  GaborSample sum{};
  for (std::uint32_t b = layer.parts.first; b < layer.parts.first + layer.parts.count; ++b) {
    for (std::uint32_t j = block.first_gabor[b]; j < block.first_gabor[b + 1]; ++j) {
      sum = with_impulse(block.gabor[j], f.bands[b].draw.amplitude, q, sum);
    }
  }
  for (int k = 0; k < 4; ++k) {
    heights[k] = height_beside(sum, p[k].x - center.x, p[k].y - center.y, p[k].z - center.z, layer.clip);
  }
}

// What the craters that reach a block make of the elevation at a point of the bare surface.
ASTROLITH_HD inline float flat_cratered(const FlatField& f, const FlatLayer& layer, const FlatBlock& block,
                                        const Vec3f& p, float elevation) {
  for (std::uint32_t k = block.first_landform[layer.list]; k < block.first_landform[layer.list + 1]; ++k) {
    const CraterKernel& crater = f.craters[layer.parts.first + block.landforms[k]];
    elevation = cratered(crater, crater_distance_squared(crater, p.x, p.y, p.z), elevation);
  }
  return math::clamp(elevation, -layer.clip, layer.clip);
}

ASTROLITH_HD inline float flat_weight(const FlatField& f, const FlatWeight& weight, const Vec3f& p) {
  const auto distance = [&](const FlatRange& spheres) {
    float least = std::numeric_limits<float>::max();
    for (std::uint32_t s = spheres.first; s < spheres.first + spheres.count; ++s) {
      const WeightSphere& sphere = f.weight_spheres[s];
      least = nearer_sphere(sphere.center, sphere.radius, p.x, p.y, p.z, least);
    }
    return least;
  };
  if (weight.others.count == 0) return 1.0f;
  return local_weight(distance(weight.near), distance(weight.others), weight.inverse_width);
}

// Of a noise in space.
ASTROLITH_HD inline float flat_height(const FlatField& f, const FlatLayer& layer, const FlatBlock& block,
                                      const Vec3f& p) {
  switch (layer.kind) {
    case FlatNoise::kFractal:
      return flat_fractal(f, layer, p);
    case FlatNoise::kSparse:
      return flat_sparse(f, layer, p);
    case FlatNoise::kSpots:
      return flat_spots(f, layer, block, p);
    case FlatNoise::kPhasor:
      return flat_phasor(layer, p);
    default:
      return flat_random_phase(f, layer, p);
  }
}

}  // namespace astrolith
