// Three-dimensional Worley noise (Worley 1996): the distances from a point to the nearest and the second
// nearest of random landform points, one in each cell of a cubic lattice.
//
// Feature points keep to the inner 80 % of their cells' sides, and distances are cut at 1.1 cells: what is
// nearer than that lies in the 27 cells around the point, so the noise is exact and continuous. The nearest
// point is farther in less than one place of 10^5, the second nearest in one of 2000.
#pragma once

#include <algorithm>

#include "synthesis/noise/lattice_noise.h"

namespace astrolith {

inline constexpr float kWorleyJitter = 0.8f;           // side of a landform point's range, in cells
inline constexpr float kWorleyFarthest = 1.1f;         // 3/2 - jitter/2 cells
inline constexpr float kWorleyScale = 1.0f / 1.1001f;  // to [0, 1]; rounded down
inline constexpr float kWorleyMeanF1 = 0.4629f;        // of distances in units of kWorleyFarthest, measured
inline constexpr float kWorleyMeanF2 = 0.6499f;

// Squared distances in cells, at most kWorleyFarthest^2.
struct WorleyDistances {
  float nearest, second;
};

// 23 bits as a float in [1, 2).
ASTROLITH_KERNEL float one_to_two(std::uint32_t bits) {
  return math::float_of(static_cast<std::int32_t>((bits & 0x007fffffu) | 0x3f800000u));
}

// Squared distance to a cell's landform point, which lies at jitter (m - 3/2) + 1/2 in the cell, m in [1,
// 2)^3 by its hash; (x, y, z) is the point in that cell plus 3/2 jitter - 1/2, so that one fma makes each
// difference.
ASTROLITH_KERNEL float feature_distance(std::uint32_t cell, float x, float y, float z) {
  std::uint32_t h = short_lattice_hash(cell);
  h ^= h >> 15;
  // Overlapping fields: the nine high bits of each are its own.
  const float dx = math::fma(-kWorleyJitter, one_to_two(h >> 9), x);
  const float dy = math::fma(-kWorleyJitter, one_to_two(h), y);
  const float dz = math::fma(-kWorleyJitter, one_to_two(h << 10), z);
  return math::fma(dx, dx, math::fma(dy, dy, dz * dz));
}

// kSecond: whether the second distance is wanted; without it it stays at its largest.
template <bool kSecond>
ASTROLITH_KERNEL WorleyDistances worley_distances(float x, float y, float z, std::uint32_t seed) {
  const float i = math::floor(x), j = math::floor(y), k = math::floor(z);
  constexpr float kOffset = 1.5f * kWorleyJitter - 0.5f;
  const float fx = x - i + kOffset, fy = y - j + kOffset, fz = z - k + kOffset;
  const std::uint32_t cell = lattice_point(i, j, k, seed);
  // Positive floats have the order of their bits, whose minima compilers vectorise well.
  std::int32_t nearest = math::bits_of(kWorleyFarthest * kWorleyFarthest), second = nearest;
  ASTROLITH_UNROLL
  for (int c = -1; c <= 1; ++c) {
    ASTROLITH_UNROLL
    for (int b = -1; b <= 1; ++b) {
      ASTROLITH_UNROLL
      for (int a = -1; a <= 1; ++a) {
        const std::uint32_t neighbour = cell + static_cast<std::uint32_t>(a) * kLatticeX +
                                        static_cast<std::uint32_t>(b) * kLatticeY +
                                        static_cast<std::uint32_t>(c) * kLatticeZ;
        const std::int32_t d = math::bits_of(feature_distance(
            neighbour, fx - static_cast<float>(a), fy - static_cast<float>(b), fz - static_cast<float>(c)));
        if constexpr (kSecond) second = std::min(second, std::max(nearest, d));
        nearest = std::min(nearest, d);
      }
    }
  }
  return {math::float_of(nearest), math::float_of(second)};
}

// Each has zero mean and lies in [-mean, 1 - mean], where 1 stands for kWorleyFarthest cells; standard
// deviations 0.149, 0.119 and 0.148. |x|, |y|, |z| <= 2^20.
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
