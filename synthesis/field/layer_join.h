// How a layer's heights join the elevation that the layers before it made (recipe's Combination), and with
// what weight (Locality and LayerMask).
#pragma once

#include <optional>

#include "numerics/interval.h"
#include "numerics/scalar_math.h"
#include "recipe/recipe.h"
#include "synthesis/field/local_weight.h"

namespace astrolith {

// From 0 where a height is `from` to 1.
ASTROLITH_KERNEL float smooth_step(float height, float from, float inverse_range) {
  const float t = math::clamp((height - from) * inverse_range, 0.0f, 1.0f);
  return t * t * math::fma(-2.0f, t, 3.0f);
}

// The union of surfaces at two heights, rounded at the joint: symmetric, and the higher one where width is 0.
ASTROLITH_KERNEL float rounded_max(float a, float b, float width) {
  const float d = math::abs(a - b);
  return math::fma(0.5f, math::sqrt(math::fma(d, d, width * width)) - d, math::max(a, b));
}

// The blend of a height with an elevation; sign is -1 for the intersection.
ASTROLITH_KERNEL float blended_height(float sign, float width, float elevation, float height) {
  return sign * rounded_max(sign * elevation, sign * height, width);
}

// What a height makes of an elevation that it is added to, or that it takes the place of. Where it counts
// fully there is no weight.
ASTROLITH_KERNEL float joined_elevation(bool is_change, float height, float elevation) {
  return is_change ? elevation + height : height;
}
ASTROLITH_KERNEL float joined_elevation(bool is_change, float weight, float height, float elevation) {
  return elevation + weight * (is_change ? height : height - elevation);
}

// Where a layer counts, by the heights of another, as they were there.
struct HeightMask {
  int slot = 0;  // where the other's heights are kept
  float from = 0.0f, to = 1.0f;

  // weight[i] *= t^2 (3 - 2t), which lies in [0, 1].
  void multiply(int n, const float* height, float* weight) const;
  // The weight for all heights of an interval.
  Interval bound(const Interval& heights) const;
};

struct LayerJoin {
  Combination how;
  std::optional<LocalWeight> locality;
  std::optional<HeightMask> mask;
  int keeps = -1;             // the slot where its own heights are kept for masks; -1: they are not
  Vec3d displaced;            // its coordinates are at most so far from the points, by axis
  double change_bound = 0.0;  // of what it makes of an elevation
  double height_bound = 0.0;  // of its heights, times what they weigh

  bool changes_elevation() const { return how.kind != Combine::kWarp && how.kind != Combine::kMask; }
};

// The most |elevation| after a layer whose heights are at most `height`, where it was at most `before`.
double elevation_bound(const Combination& how, double before, double height);

// elevation[i] becomes what the layer makes of it; `weight` is null where it counts fully everywhere.
// `height` is used up. Expects a layer that changes elevations.
void join_elevation(const Combination& how, int n, const float* weight, float* height, float* elevation);

// The same for intervals.
Interval join_bounds(const Combination& how, const Interval& weight, const Interval& before,
                     const Interval& height);

}  // namespace astrolith
