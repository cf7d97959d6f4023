// Levels of a relief below the edges of the model that was measured: its own ground on a plane that repeats
// (relief_level_ground.h), a quarter as large from level to level, tiled and blended as an exemplar is.
#pragma once

#include <cstdint>

#include "numerics/arrays.h"
#include "synthesis/exemplar/exemplar_noise.h"

namespace astrolith {

struct ReliefLevel {
  ExemplarNoise noise;  // heights over the roughness around a point
  float gain = 0.0f;    // 4^(-H k) of level k
};

struct ReliefLevels {
  ArrayRange<ReliefLevel> levels;
  ArrayRange<std::uint32_t> words;  // (tiles x kReliefTileSize) weight << 16 | code of the roughness
  float step = 0.0f;                // roughness of a code above the one before, length units; that of 0 is 0
  double least = 0.0, greatest = 0.0;  // bounds of the heights, length units
};

// The sum of the levels at a point of the bare surface, over the roughness there.
ASTROLITH_HD inline float level_sum(const ReliefLevels& l, const ArrayView& arrays, const Vec3f& at) {
  const ReliefLevel* levels = arrays[l.levels];
  float sum = 0.0f;
  for (std::uint32_t k = 0; k < l.levels.count; ++k) {
    sum = math::fma(levels[k].gain, height_at(levels[k].noise, arrays, at), sum);
  }
  return sum;
}

// Adds the levels times the roughness to the heights at these points. The same bits as with level_sum().
void add_levels(const ReliefLevels& l, const ArrayView& arrays, int count, const float* x, const float* y,
                const float* z, const float* roughness, float* height);

}  // namespace astrolith
