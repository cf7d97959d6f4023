// How a layer's heights join the elevation that the layers before it made (Combination in recipe/recipe.h),
// and with what weight in [0, 1] (Locality and LayerMask).
#pragma once

#include "numerics/interval.h"
#include "numerics/scalar_math.h"
#include "recipe/recipe.h"
#include "synthesis/field/local_weight.h"

namespace astrolith {

// The weight of a mask: 0 up to height `from`, 1 where the range ends, and a cubic step between.
ASTROLITH_KERNEL float smooth_step(float height, float from, float inverse_range) {
  const float t = math::clamp((height - from) * inverse_range, 0.0f, 1.0f);
  return t * t * math::fma(-2.0f, t, 3.0f);
}

// The height of the union of surfaces at heights a and b, rounded at the joint: R = (a + b + sqrt((a - b)^2 +
// width^2)) / 2. It is symmetric in a and b, and max(a, b) for width 0.
ASTROLITH_KERNEL float rounded_max(float a, float b, float width) {
  const float d = math::abs(a - b);
  return math::fma(0.5f, math::sqrt(math::fma(d, d, width * width)) - d, math::max(a, b));
}

// The blend of a height with an elevation; `sign` is 1 for the union and -1 for the intersection.
ASTROLITH_KERNEL float blended_height(float sign, float width, float elevation, float height) {
  return sign * rounded_max(sign * elevation, sign * height, width);
}

// The elevation after a layer that adds its height (is_change) or replaces the elevation by it. The form
// without a weight is for a layer of weight 1.
ASTROLITH_KERNEL float joined_elevation(bool is_change, float height, float elevation) {
  return is_change ? elevation + height : height;
}
ASTROLITH_KERNEL float joined_elevation(bool is_change, float weight, float height, float elevation) {
  return elevation + weight * (is_change ? height : height - elevation);
}

struct LayerJoin {
  Combination how;
  bool local = false;    // whether the layer is tied to a group of spheres
  LocalWeight locality;  // read only if `local`
  int keeps = -1;        // slot in which the layer's heights are kept for masks; -1: they are not kept
  int mask = -1;         // slot of the heights that mask the layer; -1: no mask
  float mask_from = 0.0f, mask_to = 1.0f, mask_inverse_range = 1.0f;
  Vec3d displaced;            // bound of the displacement of the layer's coordinates, by axis, length units
  double height_bound = 0.0;  // bound of the layer's |height|, length units
  double change_bound = 0.0;  // bound of the layer's change of an elevation, length units
  float remaining_change = 0.0f;  // bound of the change by this layer and all layers after it, length units

  ASTROLITH_HD bool changes_elevation() const {
    return how.kind != Combine::kWarp && how.kind != Combine::kMask;
  }
  // Whether the layer's heights serve nothing: they neither change the elevation, nor displace or mask other
  // layers. Such a layer is not evaluated.
  ASTROLITH_HD bool idle() const { return how.kind == Combine::kMask && keeps < 0; }
  ASTROLITH_HD bool weighted() const { return local || mask >= 0; }
};

// A bound of |elevation| after a layer with |height| <= height, where |elevation| <= before. All are in
// length units.
double elevation_bound(const Combination& how, double before, double height);

// The elevation at one point after a layer. `weight` is read only if the join is weighted. Expects a layer
// that changes elevations.
ASTROLITH_HD inline float join_elevation(const LayerJoin& join, float weight, float height, float elevation) {
  const Combination& how = join.how;
  const bool is_change = how.kind == Combine::kAdd;
  if (how.kind == Combine::kBlend) {
    height =
        blended_height(how.intersection ? -1.0f : 1.0f, static_cast<float>(how.width), elevation, height);
  }
  return join.weighted() ? joined_elevation(is_change, weight, height, elevation)
                         : joined_elevation(is_change, height, elevation);
}

// Multiplies weight[i] by the weight of the mask for height[i], for n points.
void multiply_by_mask(const LayerJoin& join, int n, const float* height, float* weight);

// Replaces elevation[i] by the elevation after the layer, for n points: the vectorised join_elevation, with
// its bits. `weight` is null for a layer of weight 1. `height` is overwritten.
void join_elevations(const Combination& how, int n, const float* weight, float* height, float* elevation);

ASTROLITH_HD inline double rounded_max(double a, double b, double width) {
  const double d = std::fabs(a - b);
  return std::max(a, b) + 0.5 * (std::sqrt(d * d + width * width) - d);
}

// The elevation after a layer of weight 1, in double precision, for bounds.
ASTROLITH_HD inline double joined_fully(const Combination& how, double before, double height) {
  if (how.kind == Combine::kAdd) return before + height;
  if (how.kind == Combine::kReplace) return height;
  if (how.kind != Combine::kBlend) return before;
  const double sign = how.intersection ? -1.0 : 1.0;
  return sign * rounded_max(sign * before, sign * height, how.width);
}

// Bounds of the elevation after a layer. The elevation is monotonic in the elevation before, in the height
// and in the weight, so that the ends of the intervals suffice.
ASTROLITH_HD inline Interval join_bounds(const Combination& how, const Interval& weight,
                                         const Interval& before, const Interval& height) {
  const double low = joined_fully(how, before.low, height.low);
  const double high = joined_fully(how, before.high, height.high);
  const auto mixed = [](double w, double a, double b) { return (1.0 - w) * a + w * b; };
  return {std::min(mixed(weight.low, before.low, low), mixed(weight.high, before.low, low)),
          std::max(mixed(weight.low, before.high, high), mixed(weight.high, before.high, high))};
}

// Bounds of the weight of a mask, from bounds of the masking layer's heights.
ASTROLITH_HD inline Interval bound_mask(float from, float to, const Interval& heights) {
  const auto at = [&](double height) {
    const double t = clamped((height - double{from}) / (double{to} - double{from}), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
  };
  const double a = at(heights.low), b = at(heights.high);
  return {std::max(0.0, std::min(a, b) - 1e-5), std::min(1.0, std::max(a, b) + 1e-5)};
}

}  // namespace astrolith
