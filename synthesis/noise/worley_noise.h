// Three-dimensional Worley noise (Worley 1996): the distances from a point to the nearest and the second
// nearest of random feature points. Each cell of a cubic lattice has one feature point.
//
// Feature points keep to the inner 80 % of the sides of their cells, and distances are clamped at 1.1 cells.
// Every feature point nearer than that lies in the 27 cells around the point, so that the noise is exact and
// continuous. The nearest feature point is farther than 1.1 cells at less than one place in 10^5, the second
// nearest at one place in 2000.
#pragma once

#include <algorithm>

#include "synthesis/noise/lattice_noise.h"

namespace astrolith {

inline constexpr float kWorleyJitter = 0.8f;           // side of the range of a feature point, in cells
inline constexpr float kWorleyFarthest = 1.1f;         // 3/2 - jitter/2, in cells
inline constexpr float kWorleyScale = 1.0f / 1.1001f;  // scales distances to [0, 1]; rounded down
inline constexpr float kWorleyMeanF1 = 0.4629f;        // mean distances in units of kWorleyFarthest, measured
inline constexpr float kWorleyMeanF2 = 0.6499f;

// Squared distances in cells, at most kWorleyFarthest^2.
struct WorleyDistances {
  float nearest, second;
};

// A float in [1, 2) from 23 bits.
ASTROLITH_KERNEL float one_to_two(std::uint32_t bits) {
  return math::from_bits(static_cast<std::int32_t>((bits & 0x007fffffu) | 0x3f800000u));
}

// The squared distance from a point to the feature point of a cell. The hash of the cell gives m in [1, 2)^3,
// and the feature point lies at jitter (m - 3/2) + 1/2 in the cell. (x, y, z) is the point's offset in the
// cell plus 3/2 jitter - 1/2, so that one fma makes each difference.
ASTROLITH_KERNEL float feature_distance(std::uint32_t cell, float x, float y, float z) {
  std::uint32_t h = short_lattice_hash(cell);
  h ^= h >> 15;
  // The bit fields of the three axes overlap, but the nine high bits of each field belong to one axis alone.
  const float dx = math::fma(-kWorleyJitter, one_to_two(h >> 9), x);
  const float dy = math::fma(-kWorleyJitter, one_to_two(h), y);
  const float dz = math::fma(-kWorleyJitter, one_to_two(h << 10), z);
  return math::fma(dx, dx, math::fma(dy, dy, dz * dz));
}

// The two squared distances at a point, in squared cells. Without kSecond, `second` stays at its largest
// value.
template <bool kSecond>
ASTROLITH_KERNEL WorleyDistances worley_distances(float x, float y, float z, std::uint32_t seed) {
  const float i = math::floor(x), j = math::floor(y), k = math::floor(z);
  constexpr float kOffset = 1.5f * kWorleyJitter - 0.5f;
  const float fx = x - i + kOffset, fy = y - j + kOffset, fz = z - k + kOffset;
  const std::uint32_t cell = lattice_point(i, j, k, seed);
  // The bits of positive floats, as integers, have the same order. Compilers vectorise integer minima well.
  std::int32_t nearest = math::to_bits(kWorleyFarthest * kWorleyFarthest), second = nearest;
  ASTROLITH_UNROLL
  for (int c = -1; c <= 1; ++c) {
    ASTROLITH_UNROLL
    for (int b = -1; b <= 1; ++b) {
      ASTROLITH_UNROLL
      for (int a = -1; a <= 1; ++a) {
        const std::uint32_t neighbour = cell + static_cast<std::uint32_t>(a) * kLatticeX +
                                        static_cast<std::uint32_t>(b) * kLatticeY +
                                        static_cast<std::uint32_t>(c) * kLatticeZ;
        const std::int32_t d = math::to_bits(feature_distance(
            neighbour, fx - static_cast<float>(a), fy - static_cast<float>(b), fz - static_cast<float>(c)));
        if constexpr (kSecond) second = std::min(second, std::max(nearest, d));
        nearest = std::min(nearest, d);
      }
    }
  }
  return {math::from_bits(nearest), math::from_bits(second)};
}

// The three noises at (x, y, z), where |x|, |y|, |z| <= 2^20, in units of kWorleyFarthest cells. Each has
// mean 0; F1 and F2 lie in [-mean, 1 - mean]. The standard deviations are 0.149, 0.119 and 0.148.
ASTROLITH_KERNEL float worley_f1(float x, float y, float z, std::uint32_t seed) {
  return math::fma(kWorleyScale, math::sqrt(worley_distances<false>(x, y, z, seed).nearest), -kWorleyMeanF1);
}
ASTROLITH_KERNEL float worley_f2(float x, float y, float z, std::uint32_t seed) {
  return math::fma(kWorleyScale, math::sqrt(worley_distances<true>(x, y, z, seed).second), -kWorleyMeanF2);
}
ASTROLITH_KERNEL float worley_f2_minus_f1(float x, float y, float z, std::uint32_t seed) {
  const WorleyDistances d = worley_distances<true>(x, y, z, seed);
  return math::fma(kWorleyScale, math::sqrt(d.second) - math::sqrt(d.nearest), kWorleyMeanF1 - kWorleyMeanF2);
}

}  // namespace astrolith
