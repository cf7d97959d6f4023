#include "synthesis/field/layer_join.h"

#include <algorithm>
#include <cmath>

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

}  // namespace

void multiply_by_mask(const LayerJoin& join, int n, const float* height, float* weight) {
  multiply_by_steps(n, height, join.mask_from, join.mask_inverse_range, weight);
}

double elevation_bound(const Combination& how, double before, double height) {
  if (how.kind == Combine::kAdd) return before + height;
  if (how.kind == Combine::kReplace) return std::max(before, height);
  return how.kind == Combine::kBlend ? std::max(before, height) + 0.5 * how.width : before;
}

void join_elevations(const Combination& how, int n, const float* weight, float* height, float* elevation) {
  if (how.kind == Combine::kBlend) {
    blend(n, how.intersection ? -1.0f : 1.0f, static_cast<float>(how.width), elevation, height);
  }
  const bool is_change = how.kind == Combine::kAdd;
  for (int i = 0; i < n; ++i) {
    elevation[i] = weight == nullptr ? joined_elevation(is_change, height[i], elevation[i])
                                     : joined_elevation(is_change, weight[i], height[i], elevation[i]);
  }
}

}  // namespace astrolith
