// Hashes of lattice points, and gradients chosen by these hashes, for all lattice noises. The code has
// neither branches nor tables, so that compilers vectorise it over points. Selections use sign bits and
// integer logic, since compilers entangle several conditions on one hash.
#pragma once

#include <cstdint>

#include "numerics/host_device.h"
#include "numerics/scalar_math.h"
#include "numerics/vec3.h"

namespace astrolith {

// The value of a noise, and its gradient per unit of the argument.
struct NoiseSample {
  float value;
  Vec3f gradient;
};

// The lattice point (i, j, k) is identified by seed + i kLatticeX + j kLatticeY + k kLatticeZ, modulo 2^32.
inline constexpr std::uint32_t kLatticeX = 0x8da6b343u, kLatticeY = 0xd8163841u, kLatticeZ = 0xcb1ab31fu;

// Expects whole numbers i, j, k of at most 2^24 in magnitude.
ASTROLITH_KERNEL std::uint32_t lattice_point(float i, float j, float k, std::uint32_t seed) {
  return seed + static_cast<std::uint32_t>(static_cast<std::int32_t>(i)) * kLatticeX +
         static_cast<std::uint32_t>(static_cast<std::int32_t>(j)) * kLatticeY +
         static_cast<std::uint32_t>(static_cast<std::int32_t>(k)) * kLatticeZ;
}

// What moves the number of a lattice point by (i, j, k) points.
ASTROLITH_HD inline std::uint32_t lattice_step(std::int64_t i, std::int64_t j, std::int64_t k) {
  return static_cast<std::uint32_t>(i) * kLatticeX + static_cast<std::uint32_t>(j) * kLatticeY +
         static_cast<std::uint32_t>(k) * kLatticeZ;
}

// Hashes of a lattice point whose top bits choose a gradient. Simplex noise keeps two rounds of mixing, so
// that its recipes keep their shapes. One round is enough for the cubic lattices, and faster.
ASTROLITH_KERNEL std::uint32_t lattice_hash(std::uint32_t point) {
  point = (point ^ (point >> 16)) * 0x7feb352du;
  return (point ^ (point >> 15)) * 0x846ca68bu;
}
ASTROLITH_KERNEL std::uint32_t short_lattice_hash(std::uint32_t point) {
  point ^= point >> 15;
  return point * (point + 0x7feb352du);  // a constant factor would leave neighbours correlated
}

// Returns a if the top bit of `sign` is set, else b.
ASTROLITH_KERNEL float choose_by_sign(std::uint32_t sign, float a, float b) {
  const std::int32_t mask = static_cast<std::int32_t>(sign) >> 31;
  return math::from_bits((math::to_bits(a) & mask) | (math::to_bits(b) & ~mask));
}

// Returns v, with its sign changed if the top bit of `sign` is set.
ASTROLITH_KERNEL float flip_sign(float v, std::uint32_t sign) {
  return math::from_bits(math::to_bits(v) ^ static_cast<std::int32_t>(sign & 0x80000000u));
}

// The dot product of (x, y, z) with one of the twelve edge directions of a cube. The top four bits g of the
// hash choose the direction (Perlin 2002): u = y if g >= 8, else x; v = y if g < 4, x if g is 12 or 14, else
// z; the product is +-u +-v.
ASTROLITH_KERNEL float gradient_product(std::uint32_t hash, float x, float y, float z) {
  const float u = choose_by_sign(hash, y, x);
  const float x_or_z = choose_by_sign(hash & (hash << 1) & ~(hash << 3), x, z);
  const float v = choose_by_sign(hash | (hash << 1), x_or_z, y);
  return flip_sign(u, hash << 3) + flip_sign(v, hash << 2);
}

ASTROLITH_KERNEL Vec3f lattice_gradient(std::uint32_t hash) {
  return {gradient_product(hash, 1.0f, 0.0f, 0.0f), gradient_product(hash, 0.0f, 1.0f, 0.0f),
          gradient_product(hash, 0.0f, 0.0f, 1.0f)};
}

}  // namespace astrolith
