// A sparse layer of the recipe, ready for evaluation over many points: white noise, mostly zero, upscaled
// level by level and clamped.
//
// Upscaling an image again and again by quadratic interpolation makes of one pixel a quadratic B-spline in
// each direction: each level is the sum of such bumps, evaluated where it is needed and never stored.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "numerics/interval.h"
#include "recipe/recipe.h"
#include "synthesis/noise/lattice_noise.h"

namespace astrolith {

// Of a bump of value 1, alone.
inline constexpr float kInverseBumpHeight = 64.0f / 27.0f;  // (4/3)^3

// A cell's value: zero, or with the probability uniform in [0, 1).
ASTROLITH_KERNEL float sparse_value(float i, float j, float k, std::uint32_t seed, float probability,
                                    float inverse_probability) {
  const std::uint32_t hash = lattice_hash(lattice_point(i, j, k, seed));
  const float u = static_cast<float>(static_cast<std::int32_t>((hash ^ (hash >> 15)) >> 8)) * 0x1p-24f;
  return u < probability ? u * inverse_probability : 0.0f;
}

// The quadratic B-splines of the three cells nearest to a coordinate, d from the middle one's centre.
struct BumpWeights {
  float below, at, above;
};
ASTROLITH_KERNEL BumpWeights bump_weights(float d) {
  const float below = 0.5f - d, above = 0.5f + d;
  return {0.5f * below * below, 0.75f - d * d, 0.5f * above * above};
}

// Upscaled noise of unit cells centred at whole coordinates; from 0 to 64/27, and 1 on a lone value of 1.
ASTROLITH_KERNEL float upscaled_noise(float x, float y, float z, std::uint32_t seed, float probability,
                                      float inverse_probability) {
  const float i = math::floor(x + 0.5f), j = math::floor(y + 0.5f), k = math::floor(z + 0.5f);
  const BumpWeights wx = bump_weights(x - i), wy = bump_weights(y - j), wz = bump_weights(z - k);
  const auto value = [&](float ci, float cj, float ck) {
    return sparse_value(ci, cj, ck, seed, probability, inverse_probability);
  };
  const auto row = [&](float cj, float ck) {
    return math::fma(wx.below, value(i - 1.0f, cj, ck),
                     math::fma(wx.above, value(i + 1.0f, cj, ck), wx.at * value(i, cj, ck)));
  };
  const auto plane = [&](float ck) {
    return math::fma(wy.below, row(j - 1.0f, ck), math::fma(wy.above, row(j + 1.0f, ck), wy.at * row(j, ck)));
  };
  return kInverseBumpHeight *
         math::fma(wz.below, plane(k - 1.0f), math::fma(wz.above, plane(k + 1.0f), wz.at * plane(k)));
}

struct SparseLevel {
  float frequency;  // cells per length unit
  float gain;       // of this level over the first
  std::uint32_t seed;
};

// A level's part of the sum at a value of its noise, and the height from the whole sum.
ASTROLITH_KERNEL float with_sparse_level(float gain, float noise, float cut, float sum) {
  return sum + gain * math::max(noise - cut, 0.0f);
}
ASTROLITH_KERNEL float sparse_height(float amplitude, float sum, float cut) {
  return -amplitude * math::max(sum - cut, 0.0f);
}

class SparseNoise {
 public:
  // As FractalNoise: levels too fine for float coordinates within the domain are left out.
  SparseNoise(const SparseLayer& layer, std::uint64_t seed, int layer_index, const Box& domain);

  // height[i] = n(p_i), length units.
  void evaluate(int n, const float* x, const float* y, const float* z, float* height) const;

  // |n(p)| never exceeds this.
  double height_bound() const { return height_bound_; }

  // n(p) at every float point of a box.
  Interval bound_heights(const Box& box) const;

  // What it is made of. A level is cut, or the sum of all.
  struct Parts {
    Vec3f domain_min, domain_max;
    std::span<const SparseLevel> levels;
    float amplitude, level_cut, sum_cut, probability, inverse_probability;
  };
  Parts parts() const {
    return {domain_min_,
            domain_max_,
            levels_,
            amplitude_,
            merged_ ? 0.0f : threshold_,
            merged_ ? threshold_ : 0.0f,
            probability_,
            inverse_probability_};
  }

 private:
  std::vector<SparseLevel> levels_;
  float amplitude_, threshold_, probability_, inverse_probability_;
  bool merged_;
  Vec3f domain_min_, domain_max_;
  double height_bound_ = 0.0;
};

}  // namespace astrolith
