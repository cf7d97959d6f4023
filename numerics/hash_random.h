// Random numbers are hashes of what they are for. Code that runs on CPU and GPU hashes (seed, layer, cell,
// index); sequential algorithms on the host hash (seed, stream, counter). No state is shared, so neither the
// number of threads nor the order nor the device changes a number.
#pragma once

#include <cmath>
#include <cstdint>

#include "numerics/host_device.h"
#include "numerics/portable_angles.h"
#include "numerics/portable_double.h"

namespace astrolith {

// A bijection of 32-bit integers with good avalanche: two rounds of multiply and xor-shift.
ASTROLITH_HD inline std::uint32_t mix_bits(std::uint32_t h) {
  h ^= h >> 16;
  h *= 0x7feb352du;
  h ^= h >> 15;
  h *= 0x846ca68bu;
  h ^= h >> 16;
  return h;
}

// Folds one more integer into a hash; the order of the integers matters.
ASTROLITH_HD inline std::uint32_t hash_append(std::uint32_t h, std::uint32_t value) {
  return mix_bits(h * 0x9e3779b1u + value + 0x85ebca77u);
}

// Start of a cell's hash: the seed of the recipe and the number of the layer (and band) in it.
ASTROLITH_HD inline std::uint32_t hash_seed(std::uint64_t seed, std::uint32_t layer) {
  const std::uint32_t low = mix_bits(static_cast<std::uint32_t>(seed));
  return hash_append(hash_append(low, static_cast<std::uint32_t>(seed >> 32)), layer);
}

ASTROLITH_HD inline std::uint32_t hash_cell(std::uint32_t h, std::int32_t x, std::int32_t y, std::int32_t z) {
  h = hash_append(h, static_cast<std::uint32_t>(x));
  h = hash_append(h, static_cast<std::uint32_t>(y));
  return hash_append(h, static_cast<std::uint32_t>(z));
}

// hash_cell() for cell numbers of 64 bits. Numbers that fit into 32 bits give the bits of hash_cell().
ASTROLITH_HD inline std::uint32_t hash_append_wide(std::uint32_t h, std::int64_t value) {
  h = hash_append(h, static_cast<std::uint32_t>(value));
  return value == static_cast<std::int32_t>(value)
             ? h
             : hash_append(h, static_cast<std::uint32_t>(static_cast<std::uint64_t>(value) >> 32));
}
ASTROLITH_HD inline std::uint32_t hash_wide_cell(std::uint32_t h, std::int64_t x, std::int64_t y,
                                                 std::int64_t z) {
  return hash_append_wide(hash_append_wide(hash_append_wide(h, x), y), z);
}

// Uniform in [0, 1) with 24 random bits: exact in a float.
ASTROLITH_HD inline float unit_float(std::uint32_t h) {
  return static_cast<float>(h >> 8) * 5.9604644775390625e-8f;
}

// A stream of doubles for sequential host algorithms; two streams of one seed are independent.
class CounterRandom {
 public:
  explicit CounterRandom(std::uint64_t seed, std::uint64_t stream = 0)
      : key_(mix(seed + 0x9e3779b97f4a7c15u) ^ mix(stream + 0xd1b54a32d192ed03u)) {}

  std::uint64_t next() { return mix(key_ + 0x9e3779b97f4a7c15u * ++counter_); }
  // Uniform in [0, 1) with 53 random bits.
  double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  // Uniform in 0 .. n-1; n > 0.
  std::uint64_t below(std::uint64_t n) {
    __extension__ using Wide = unsigned __int128;
    return static_cast<std::uint64_t>((static_cast<Wide>(next()) * n) >> 64);
  }
  // Standard normal (Box and Muller, the cosine half only: one output a call keeps the stream simple).
  double normal() {
    const double radius = std::sqrt(-2.0 * portable::log(1.0 - uniform()));
    return radius * portable::cos(6.283185307179586 * uniform());
  }

 private:
  // The finaliser of splitmix64 (Steele, Lea and Flood 2014).
  static std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }

  std::uint64_t key_;
  std::uint64_t counter_ = 0;
};

}  // namespace astrolith
