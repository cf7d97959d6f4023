// What lattice noises share: hashes of lattice points, and gradients chosen by them. No branches and no
// tables, so that compilers vectorise over points. Selections are made by sign bits with integer logic: the
// compiler tangles conditions on one hash with each other.
#pragma once

#include <cstdint>

#include "numerics/host_device.h"
#include "numerics/scalar_math.h"
#include "numerics/vec3.h"

namespace astrolith {

// A noise and its gradient per unit of its argument.
struct NoiseSample {
  float value;
  Vec3f gradient;
};

// A lattice point (i, j, k) as an integer: seed + i kLatticeX + j kLatticeY + k kLatticeZ, modulo 2^32.
inline constexpr std::uint32_t kLatticeX = 0x8da6b343u, kLatticeY = 0xd8163841u, kLatticeZ = 0xcb1ab31fu;

// i, j, k: whole numbers, at most 2^24 in magnitude.
ASTROLITH_KERNEL std::uint32_t lattice_point(float i, float j, float k, std::uint32_t seed) {
  return seed + static_cast<std::uint32_t>(static_cast<std::int32_t>(i)) * kLatticeX +
         static_cast<std::uint32_t>(static_cast<std::int32_t>(j)) * kLatticeY +
         static_cast<std::uint32_t>(static_cast<std::int32_t>(k)) * kLatticeZ;
}

// Enough mixing for the top bits to choose a gradient. Simplex noise takes two rounds, as its recipes do
// since the first of them; one does as well for the cubic lattices, and is faster.
ASTROLITH_KERNEL std::uint32_t lattice_hash(std::uint32_t point) {
  point = (point ^ (point >> 16)) * 0x7feb352du;
  return (point ^ (point >> 15)) * 0x846ca68bu;
}
ASTROLITH_KERNEL std::uint32_t short_lattice_hash(std::uint32_t point) {
  point ^= point >> 15;
  return point * (point + 0x7feb352du);  // by itself: a constant factor would leave neighbours correlated
}

// a where the top bit of `sign` is set, else b.
ASTROLITH_KERNEL float choose_by_sign(std::uint32_t sign, float a, float b) {
  const std::int32_t mask = static_cast<std::int32_t>(sign) >> 31;
  return math::float_of((math::bits_of(a) & mask) | (math::bits_of(b) & ~mask));
}

// v with its sign changed where the top bit of `sign` is set.
ASTROLITH_KERNEL float flip_sign(float v, std::uint32_t sign) {
  return math::float_of(math::bits_of(v) ^ static_cast<std::int32_t>(sign & 0x80000000u));
}

// The product of (x, y, z) with one of the twelve edge directions of a cube, chosen by the top four bits g of
// the hash (Perlin 2002): u = x, or y where g >= 8; v = y where g < 4, x where g is 12 or 14, else z.
ASTROLITH_KERNEL float gradient_product(std::uint32_t hash, float x, float y, float z) {
  const float u = choose_by_sign(hash, y, x);
  const float x_or_z = choose_by_sign(hash & (hash << 1) & ~(hash << 3), x, z);
  const float v = choose_by_sign(hash | (hash << 1), x_or_z, y);
  return flip_sign(u, hash << 3) + flip_sign(v, hash << 2);
}

ASTROLITH_KERNEL Vec3f gradient_of(std::uint32_t hash) {
  return {gradient_product(hash, 1.0f, 0.0f, 0.0f), gradient_product(hash, 0.0f, 1.0f, 0.0f),
          gradient_product(hash, 0.0f, 0.0f, 1.0f)};
}

}  // namespace astrolith
