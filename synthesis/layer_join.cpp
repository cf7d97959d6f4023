#include "synthesis/layer_join.h"

#include <algorithm>
#include <cmath>

#include "numerics/scalar_math.h"

namespace astrolith {
namespace {

ASTROLITH_SIMD_CLONES void multiply_by_steps(int n, const float* __restrict height, float from,
                                             float inverse_range, float* __restrict weight) {
#pragma omp simd
  for (int i = 0; i < n; ++i) weight[i] *= smooth_step(height[i], from, inverse_range);
}

ASTROLITH_SIMD_CLONES void blend(int n, float sign, float width, const float* __restrict elevation,
                                 float* __restrict height) {
#pragma omp simd
  for (int i = 0; i < n; ++i) height[i] = blended_height(sign, width, elevation[i], height[i]);
}

double rounded_max(double a, double b, double width) {
  const double d = std::fabs(a - b);
  return std::max(a, b) + 0.5 * (std::sqrt(d * d + width * width) - d);
}

// What a layer makes of one elevation where its weight is 1.
double joined_fully(const Combination& how, double before, double height) {
  if (how.kind == Combine::kAdd) return before + height;
  if (how.kind == Combine::kReplace) return height;
  if (how.kind != Combine::kBlend) return before;
  const double sign = how.intersection ? -1.0 : 1.0;
  return sign * rounded_max(sign * before, sign * height, how.width);
}

}  // namespace

void HeightMask::multiply(int n, const float* height, float* weight) const {
  multiply_by_steps(n, height, from, 1.0f / (to - from), weight);
}

Interval HeightMask::bound(const Interval& heights) const {
  const auto at = [&](double height) {
    const double t = std::clamp((height - double{from}) / (double{to} - double{from}), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
  };
  const double a = at(heights.low), b = at(heights.high);
  return {std::max(0.0, std::min(a, b) - 1e-5), std::min(1.0, std::max(a, b) + 1e-5)};
}

double elevation_bound(const Combination& how, double before, double height) {
  if (how.kind == Combine::kAdd) return before + height;
  if (how.kind == Combine::kReplace) return std::max(before, height);
  return how.kind == Combine::kBlend ? std::max(before, height) + 0.5 * how.width : before;
}

void join_elevation(const Combination& how, int n, const float* weight, float* height, float* elevation) {
  if (how.kind == Combine::kBlend) {
    blend(n, how.intersection ? -1.0f : 1.0f, static_cast<float>(how.width), elevation, height);
  }
  const bool is_change = how.kind == Combine::kAdd;
  for (int i = 0; i < n; ++i) {
    elevation[i] = weight == nullptr ? joined_elevation(is_change, height[i], elevation[i])
                                     : joined_elevation(is_change, weight[i], height[i], elevation[i]);
  }
}

// Each is monotonic in the elevation before, in the height and in the weight.
Interval joined(const Combination& how, const Interval& weight, const Interval& before,
                const Interval& height) {
  const double low = joined_fully(how, before.low, height.low);
  const double high = joined_fully(how, before.high, height.high);
  const auto mixed = [](double w, double a, double b) { return (1.0 - w) * a + w * b; };
  return {std::min(mixed(weight.low, before.low, low), mixed(weight.high, before.low, low)),
          std::max(mixed(weight.low, before.high, high), mixed(weight.high, before.high, high))};
}

}  // namespace astrolith
