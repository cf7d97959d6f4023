// Three-dimensional simplex noise (Perlin 2001, in the form of Gustavson 2005). Each corner of a tetrahedral
// lattice has a gradient, whose contribution fades to 0 within the neighbouring cells.
#pragma once

#include "synthesis/noise/lattice_noise.h"

namespace astrolith {

// A search over all positions and gradients found the largest sum of corner contributions, 0.013007. The
// scale is its reciprocal, rounded down, so that the noise lies in [-1, 1].
inline constexpr float kSimplexScale = 76.8f;

// A point in its tetrahedron: its offsets from the four corners, and the lattice points of the corners.
struct SimplexCell {
  Vec3f from[4];
  std::uint32_t corner[4];
};

ASTROLITH_KERNEL float one_where(std::int32_t mask) { return math::from_bits(0x3f800000 & mask); }

ASTROLITH_KERNEL SimplexCell simplex_cell(float x, float y, float z, std::uint32_t seed) {
  constexpr float kUnskew = 1.0f / 6.0f;
  const float skew = (x + y + z) * (1.0f / 3.0f);
  const float i = math::floor(x + skew), j = math::floor(y + skew), k = math::floor(z + skew);
  const float unskew = (i + j + k) * kUnskew;
  const float x0 = x - (i - unskew), y0 = y - (j - unskew), z0 = z - (k - unskew);

  // The second corner steps along the largest coordinate, the third along the two largest.
  const std::int32_t below_y = math::to_bits(x0 - y0) >> 31, below_z = math::to_bits(x0 - z0) >> 31,
                     y_below_z = math::to_bits(y0 - z0) >> 31;
  const std::int32_t i1 = ~below_y & ~below_z, j1 = below_y & ~y_below_z, k1 = below_z & y_below_z;
  const std::int32_t i2 = ~(below_y & below_z), j2 = below_y | ~y_below_z, k2 = below_z | y_below_z;
  const auto stepped = [](std::int32_t along_x, std::int32_t along_y, std::int32_t along_z) {
    return (kLatticeX & static_cast<std::uint32_t>(along_x)) +
           (kLatticeY & static_cast<std::uint32_t>(along_y)) +
           (kLatticeZ & static_cast<std::uint32_t>(along_z));
  };
  const std::uint32_t first = lattice_point(i, j, k, seed);
  return {{{x0, y0, z0},
           {x0 - one_where(i1) + kUnskew, y0 - one_where(j1) + kUnskew, z0 - one_where(k1) + kUnskew},
           {x0 - one_where(i2) + 2.0f * kUnskew, y0 - one_where(j2) + 2.0f * kUnskew,
            z0 - one_where(k2) + 2.0f * kUnskew},
           {x0 - 0.5f, y0 - 0.5f, z0 - 0.5f}},
          {first, first + stepped(i1, j1, k1), first + stepped(i2, j2, k2),
           first + (kLatticeX + kLatticeY + kLatticeZ)}};
}

// The fade 1/2 - r^2, and 0 beyond r^2 = 1/2, where neighbouring cells begin. A larger radius would make the
// noise discontinuous.
ASTROLITH_KERNEL float simplex_fade(const Vec3f& d) {
  return math::max(0.5f - math::fma(d.x, d.x, math::fma(d.y, d.y, d.z * d.z)), 0.0f);
}

// The contribution of one corner, fade^4 gradient.d.
ASTROLITH_KERNEL float simplex_corner(std::uint32_t corner, const Vec3f& d) {
  const float fade = simplex_fade(d);
  const float fade2 = fade * fade;
  return fade2 * fade2 * gradient_product(lattice_hash(corner), d.x, d.y, d.z);
}

// Simplex noise at (x, y, z), where |x|, |y|, |z| <= 2^20. Range [-1, 1], mean 0, standard deviation 0.389,
// about one feature per unit length.
ASTROLITH_KERNEL float simplex_noise(float x, float y, float z, std::uint32_t seed) {
  const SimplexCell cell = simplex_cell(x, y, z, seed);
  const float n0 = simplex_corner(cell.corner[0], cell.from[0]);
  const float n1 = simplex_corner(cell.corner[1], cell.from[1]);
  const float n2 = simplex_corner(cell.corner[2], cell.from[2]);
  const float n3 = simplex_corner(cell.corner[3], cell.from[3]);
  return kSimplexScale * ((n0 + n1) + (n2 + n3));
}

// Adds the contribution of one corner, and its gradient fade^4 g - 8 fade^3 (g.d) d.
ASTROLITH_KERNEL void add_simplex_corner(std::uint32_t corner, const Vec3f& d, NoiseSample& sum) {
  const std::uint32_t hash = lattice_hash(corner);
  const Vec3f g = lattice_gradient(hash);
  const float fade = simplex_fade(d);
  const float fade2 = fade * fade, fade4 = fade2 * fade2;
  const float product = gradient_product(hash, d.x, d.y, d.z);
  const float radial = -8.0f * fade2 * fade * product;
  sum.value += fade4 * product;
  sum.gradient.x += math::fma(radial, d.x, fade4 * g.x);
  sum.gradient.y += math::fma(radial, d.y, fade4 * g.y);
  sum.gradient.z += math::fma(radial, d.z, fade4 * g.z);
}

// simplex_noise() with its gradient. The last bits of the value differ, since the sum has another order.
ASTROLITH_KERNEL NoiseSample simplex_with_gradient(float x, float y, float z, std::uint32_t seed) {
  const SimplexCell cell = simplex_cell(x, y, z, seed);
  NoiseSample sum{};
  add_simplex_corner(cell.corner[0], cell.from[0], sum);
  add_simplex_corner(cell.corner[1], cell.from[1], sum);
  add_simplex_corner(cell.corner[2], cell.from[2], sum);
  add_simplex_corner(cell.corner[3], cell.from[3], sum);
  return {kSimplexScale * sum.value, kSimplexScale * sum.gradient};
}

}  // namespace astrolith
