// Three-dimensional simplex noise (Perlin 2001, after Gustavson's exposition 2005): gradients at the corners
// of a lattice of tetrahedra, each fading out inside its neighbours. No branches and no tables: the gradient
// is a hash of the corner.
#pragma once

#include <cstdint>

#include "numerics/host_device.h"
#include "numerics/scalar_math.h"

namespace astrolith {

// The largest sum of corner contributions is 0.013007 (by search over all positions and gradients); its
// reciprocal, rounded down, keeps the noise within [-1, 1].
inline constexpr float kSimplexScale = 76.8f;

// Of three integers multiplied into `sum` already: enough mixing for the top bits to choose a gradient.
ASTROLITH_KERNEL std::uint32_t lattice_hash(std::uint32_t sum) {
  sum = (sum ^ (sum >> 16)) * 0x7feb352du;
  return (sum ^ (sum >> 15)) * 0x846ca68bu;
}

// (1/2 - r^2)^4 gradient.(x, y, z), zero beyond r^2 = 1/2, where neighbouring cells begin: a larger radius
// would make the noise jump. The gradient is one of the twelve edge directions of a cube (Perlin 2002).
ASTROLITH_KERNEL float simplex_corner(std::uint32_t hash, float x, float y, float z) {
  const float fade = math::max(0.5f - math::fma(x, x, math::fma(y, y, z * z)), 0.0f);
  const std::uint32_t g = hash >> 28;
  const float u = g < 8 ? x : y;
  const float v = g < 4 ? y : ((g & 13) == 12 ? x : z);
  const float signed_u = math::float_of(math::bits_of(u) ^ static_cast<std::int32_t>((g & 1) << 31));
  const float signed_v = math::float_of(math::bits_of(v) ^ static_cast<std::int32_t>((g & 2) << 30));
  const float fade2 = fade * fade;
  return fade2 * fade2 * (signed_u + signed_v);
}

// In [-1, 1], zero mean, about one feature a unit length; |x|, |y|, |z| <= 2^20.
ASTROLITH_KERNEL float simplex_noise(float x, float y, float z, std::uint32_t seed) {
  constexpr float kUnskew = 1.0f / 6.0f;
  const float skew = (x + y + z) * (1.0f / 3.0f);
  const float i = math::floor(x + skew), j = math::floor(y + skew), k = math::floor(z + skew);
  const float unskew = (i + j + k) * kUnskew;
  const float x0 = x - (i - unskew), y0 = y - (j - unskew), z0 = z - (k - unskew);

  // The tetrahedron: its second corner steps along the largest coordinate, its third along the two largest.
  const bool xy = x0 >= y0, yz = y0 >= z0, xz = x0 >= z0;
  const bool i1 = xy && xz, j1 = !xy && yz, k1 = !xz && !yz;
  const bool i2 = xy || xz, j2 = !xy || yz, k2 = !(xz && yz);

  constexpr std::uint32_t kX = 0x8da6b343u, kY = 0xd8163841u, kZ = 0xcb1ab31fu;
  const std::uint32_t sum = seed + static_cast<std::uint32_t>(static_cast<std::int32_t>(i)) * kX +
                            static_cast<std::uint32_t>(static_cast<std::int32_t>(j)) * kY +
                            static_cast<std::uint32_t>(static_cast<std::int32_t>(k)) * kZ;
  const std::uint32_t sum1 = sum + (i1 ? kX : 0u) + (j1 ? kY : 0u) + (k1 ? kZ : 0u);
  const std::uint32_t sum2 = sum + (i2 ? kX : 0u) + (j2 ? kY : 0u) + (k2 ? kZ : 0u);

  const float n0 = simplex_corner(lattice_hash(sum), x0, y0, z0);
  const float n1 = simplex_corner(lattice_hash(sum1), x0 - (i1 ? 1.0f : 0.0f) + kUnskew,
                                  y0 - (j1 ? 1.0f : 0.0f) + kUnskew, z0 - (k1 ? 1.0f : 0.0f) + kUnskew);
  const float n2 =
      simplex_corner(lattice_hash(sum2), x0 - (i2 ? 1.0f : 0.0f) + 2.0f * kUnskew,
                     y0 - (j2 ? 1.0f : 0.0f) + 2.0f * kUnskew, z0 - (k2 ? 1.0f : 0.0f) + 2.0f * kUnskew);
  const float n3 = simplex_corner(lattice_hash(sum + (kX + kY + kZ)), x0 - 0.5f, y0 - 0.5f, z0 - 0.5f);
  return kSimplexScale * ((n0 + n1) + (n2 + n3));
}

}  // namespace astrolith
