#include "synthesis/relief/relief_levels.h"

#include <vector>

namespace astrolith {

void add_levels(const ReliefLevels& l, const ArrayView& arrays, int count, const float* x, const float* y,
                const float* z, const float* roughness, float* height) {
  const auto n = static_cast<std::size_t>(count);
  std::vector<float> sums(n, 0.0f), level_heights(n);
  for (const ReliefLevel& level : arrays.span(l.levels)) {
    evaluate_heights(level.noise, arrays, count, x, y, z, level_heights.data());
    for (std::size_t i = 0; i < n; ++i) sums[i] = math::fma(level.gain, level_heights[i], sums[i]);
  }
  for (std::size_t i = 0; i < n; ++i) height[i] = math::fma(roughness[i], sums[i], height[i]);
}

}  // namespace astrolith
