// Three-dimensional improved Perlin noise (Perlin 2002): gradients at the corners of a cubic lattice, blended
// by polynomials of fifth order.
#pragma once

#include "synthesis/noise/lattice_noise.h"

namespace astrolith {

// A search over all positions and gradients found the largest blend of gradients, 1.03635. The scale is its
// reciprocal, rounded down, so that the noise lies in [-1, 1].
inline constexpr float kPerlinScale = 0.9649f;

// The fade 6 t^5 - 15 t^4 + 10 t^3 rises from 0 to 1; its first two derivatives vanish at both ends.
ASTROLITH_KERNEL float quintic_fade(float t) {
  return t * t * t * math::fma(t, math::fma(t, 6.0f, -15.0f), 10.0f);
}
ASTROLITH_KERNEL float quintic_slope(float t) { return 30.0f * t * t * math::fma(t, t - 2.0f, 1.0f); }

ASTROLITH_KERNEL float lerp(float a, float b, float t) { return math::fma(t, b - a, a); }

// Eight values at the corners of a cube, x fastest: for example the products of gradient and offset.
struct CubeCorners {
  float at[8];
};
ASTROLITH_KERNEL float blend(const CubeCorners& c, float u, float v, float w) {
  return lerp(lerp(lerp(c.at[0], c.at[1], u), lerp(c.at[2], c.at[3], u), v),
              lerp(lerp(c.at[4], c.at[5], u), lerp(c.at[6], c.at[7], u), v), w);
}

// A point in its lattice cube, and the lattice point of the first corner of the cube.
struct PerlinCell {
  float x, y, z;  // [0, 1)
  std::uint32_t first;
};
ASTROLITH_KERNEL PerlinCell perlin_cell(float x, float y, float z, std::uint32_t seed) {
  const float i = math::floor(x), j = math::floor(y), k = math::floor(z);
  return {x - i, y - j, z - k, lattice_point(i, j, k, seed)};
}

ASTROLITH_KERNEL std::uint32_t corner_hash(const PerlinCell& cell, unsigned corner) {
  const std::uint32_t steps = ((corner & 1) != 0 ? kLatticeX : 0u) + ((corner & 2) != 0 ? kLatticeY : 0u) +
                              ((corner & 4) != 0 ? kLatticeZ : 0u);
  return short_lattice_hash(cell.first + steps);
}

// The dot product of gradient and offset at each corner of the cell.
ASTROLITH_KERNEL CubeCorners perlin_corners(const PerlinCell& c) {
  const float x1 = c.x - 1.0f, y1 = c.y - 1.0f, z1 = c.z - 1.0f;
  return {
      {gradient_product(corner_hash(c, 0), c.x, c.y, c.z), gradient_product(corner_hash(c, 1), x1, c.y, c.z),
       gradient_product(corner_hash(c, 2), c.x, y1, c.z), gradient_product(corner_hash(c, 3), x1, y1, c.z),
       gradient_product(corner_hash(c, 4), c.x, c.y, z1), gradient_product(corner_hash(c, 5), x1, c.y, z1),
       gradient_product(corner_hash(c, 6), c.x, y1, z1), gradient_product(corner_hash(c, 7), x1, y1, z1)}};
}

// Perlin noise at (x, y, z), where |x|, |y|, |z| <= 2^20. Range [-1, 1], mean 0, standard deviation 0.260,
// about one feature per unit length.
ASTROLITH_KERNEL float perlin_noise(float x, float y, float z, std::uint32_t seed) {
  const PerlinCell cell = perlin_cell(x, y, z, seed);
  return kPerlinScale *
         blend(perlin_corners(cell), quintic_fade(cell.x), quintic_fade(cell.y), quintic_fade(cell.z));
}

// The components of the eight gradients along one axis, whose direction is (x, y, z).
ASTROLITH_KERNEL CubeCorners gradient_parts(const PerlinCell& c, float x, float y, float z) {
  return {{gradient_product(corner_hash(c, 0), x, y, z), gradient_product(corner_hash(c, 1), x, y, z),
           gradient_product(corner_hash(c, 2), x, y, z), gradient_product(corner_hash(c, 3), x, y, z),
           gradient_product(corner_hash(c, 4), x, y, z), gradient_product(corner_hash(c, 5), x, y, z),
           gradient_product(corner_hash(c, 6), x, y, z), gradient_product(corner_hash(c, 7), x, y, z)}};
}

// perlin_noise(), bit for bit, with its gradient. The gradient has two terms: the blended gradients of the
// corners, and the corner values times the derivative of the blend.
ASTROLITH_KERNEL NoiseSample perlin_with_gradient(float x, float y, float z, std::uint32_t seed) {
  const PerlinCell cell = perlin_cell(x, y, z, seed);
  const CubeCorners c = perlin_corners(cell);
  const float u = quintic_fade(cell.x), v = quintic_fade(cell.y), w = quintic_fade(cell.z);
  const auto along = [](float a, float b, float d, float e, float s, float t) {
    return lerp(lerp(a, b, s), lerp(d, e, s), t);
  };
  const float dx = along(c.at[1] - c.at[0], c.at[3] - c.at[2], c.at[5] - c.at[4], c.at[7] - c.at[6], v, w);
  const float dy = along(c.at[2] - c.at[0], c.at[3] - c.at[1], c.at[6] - c.at[4], c.at[7] - c.at[5], u, w);
  const float dz = along(c.at[4] - c.at[0], c.at[5] - c.at[1], c.at[6] - c.at[2], c.at[7] - c.at[3], u, v);
  const Vec3f gradient{
      math::fma(quintic_slope(cell.x), dx, blend(gradient_parts(cell, 1.0f, 0.0f, 0.0f), u, v, w)),
      math::fma(quintic_slope(cell.y), dy, blend(gradient_parts(cell, 0.0f, 1.0f, 0.0f), u, v, w)),
      math::fma(quintic_slope(cell.z), dz, blend(gradient_parts(cell, 0.0f, 0.0f, 1.0f), u, v, w))};
  return {kPerlinScale * blend(c, u, v, w), kPerlinScale * gradient};
}

}  // namespace astrolith
