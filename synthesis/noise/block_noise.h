// Angular blocks as a noise: convex solids in the cells of a cubic lattice, which the surface cuts at any
// depth. It draws ground that is strewn with blocks where they are too many to be boulders one by one.
//
// Every second cell, on average, has a block around the feature point that Worley noise has there: a ball cut
// by a box and by the faces across four of its corners, turned at random. The noise is 1 at the middle of a
// block, 0 on its faces and beyond, and linear between, so that the faces stay flat as heights. Where blocks
// overlap, the deepest counts. Blocks reach less than 1.1 cells, so that 27 cells hold all of a point.
#pragma once

#include "synthesis/noise/worley_noise.h"

namespace astrolith {

// 1 / distance of the faces from the middle: of the longest axis, the others in proportion 1 : .8 : .6, of
// the corners, and of the ball; per cell.
inline constexpr float kBlockLength = 1.8f, kBlockWidth = 1.25f * kBlockLength,
                       kBlockHeight = kBlockLength / 0.6f, kBlockCorner = 1.35f * kBlockLength,
                       kBlockBall = 0.95f * kBlockLength;
inline constexpr double kBlockMean = 0.0467, kBlockDeviation = 0.129, kBlockCover = 0.183;  // measured

// How deep a point lies in the block of a cell, at most 1; below 0 outside. (x, y, z) is its offset as
// feature_distance() takes it.
ASTROLITH_KERNEL float block_depth(std::uint32_t cell, float x, float y, float z) {
  std::uint32_t h = short_lattice_hash(cell);
  h ^= h >> 15;
  const float dx = math::fma(-kWorleyJitter, one_to_two(h >> 9), x);
  const float dy = math::fma(-kWorleyJitter, one_to_two(h), y);
  const float dz = math::fma(-kWorleyJitter, one_to_two(h << 10), z);
  // A reflection in a random plane turns the block.
  const std::uint32_t turn = lattice_hash(h);
  const float wx = math::fma(2.0f, one_to_two(turn >> 9), -3.0f);
  const float wy = math::fma(2.0f, one_to_two(turn), -3.0f);
  const float wz = math::fma(2.0f, one_to_two(turn << 10), -3.0f);
  const float across = math::fma(wx, dx, math::fma(wy, dy, wz * dz));
  const float twice = -2.0f * across / math::fma(wx, wx, math::fma(wy, wy, math::fma(wz, wz, 1e-4f)));
  const float u = math::abs(math::fma(twice, wx, dx)), v = math::abs(math::fma(twice, wy, dy)),
              w = math::abs(math::fma(twice, wz, dz));
  const float box = math::max(kBlockLength * u, math::max(kBlockWidth * v, kBlockHeight * w));
  const float corner = kBlockCorner * 0.577350269f * (u + (v + w));
  const float ball = kBlockBall * math::sqrt(math::fma(dx, dx, math::fma(dy, dy, dz * dz)));
  const float depth = 1.0f - math::max(box, math::max(corner, ball));
  return choose_by_sign(turn << 5, depth, -1.0f);
}

// The noise at (x, y, z), where |x|, |y|, |z| <= 2^20; in [0, 1].
ASTROLITH_KERNEL float block_noise(float x, float y, float z, std::uint32_t seed) {
  const float i = math::floor(x), j = math::floor(y), k = math::floor(z);
  constexpr float kOffset = 1.5f * kWorleyJitter - 0.5f;
  const float fx = x - i + kOffset, fy = y - j + kOffset, fz = z - k + kOffset;
  const std::uint32_t cell = lattice_point(i, j, k, seed);
  float deepest = 0.0f;
  ASTROLITH_UNROLL
  for (int c = -1; c <= 1; ++c) {
    ASTROLITH_UNROLL
    for (int b = -1; b <= 1; ++b) {
      ASTROLITH_UNROLL
      for (int a = -1; a <= 1; ++a) {
        const std::uint32_t neighbour = cell + static_cast<std::uint32_t>(a) * kLatticeX +
                                        static_cast<std::uint32_t>(b) * kLatticeY +
                                        static_cast<std::uint32_t>(c) * kLatticeZ;
        const float depth = block_depth(neighbour, fx - static_cast<float>(a), fy - static_cast<float>(b),
                                        fz - static_cast<float>(c));
        deepest = math::max(deepest, depth);
      }
    }
  }
  return deepest;
}

}  // namespace astrolith
