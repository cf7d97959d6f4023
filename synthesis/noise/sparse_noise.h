// A sparse layer of the recipe: white noise that is mostly zero, upscaled level by level and clamped. It is
// evaluated at one point, over many points at once, and as bounds over boxes.
//
// Repeated upscaling of an image by quadratic interpolation turns one pixel into a quadratic B-spline along
// each axis. Each level is the sum of such bumps. They are evaluated directly, and no image is stored.
#pragma once

#include <cstdint>

#include "numerics/arrays.h"
#include "numerics/interval.h"
#include "recipe/recipe.h"
#include "synthesis/noise/lattice_noise.h"
#include "synthesis/noise/noise_frame.h"
#include "synthesis/noise/noise_traits.h"

namespace astrolith {

// The inverse of the height of one bump of value 1 without neighbours.
inline constexpr float kInverseBumpHeight = 64.0f / 27.0f;  // (4/3)^3

// The value of a cell: with the given probability uniform in [0, 1), else zero.
ASTROLITH_KERNEL float sparse_value(float i, float j, float k, std::uint32_t seed, float probability,
                                    float inverse_probability) {
  const std::uint32_t hash = lattice_hash(lattice_point(i, j, k, seed));
  const float u = static_cast<float>(static_cast<std::int32_t>((hash ^ (hash >> 15)) >> 8)) * 0x1p-24f;
  return u < probability ? u * inverse_probability : 0.0f;
}

// The quadratic B-spline weights of the three nearest cells along one axis. d in [-1/2, 1/2] is the distance
// from the centre of the middle cell.
struct BumpWeights {
  float below, at, above;
};
ASTROLITH_KERNEL BumpWeights bump_weights(float d) {
  const float below = 0.5f - d, above = 0.5f + d;
  return {0.5f * below * below, 0.75f - d * d, 0.5f * above * above};
}

// Upscaled noise of unit cells with centres at whole coordinates. Range [0, 64/27]; a value of 1 without
// neighbours gives 1 at its centre.
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

// One level of upscaled noise.
struct SparseLevel {
  float frequency;  // cells per length unit
  float gain;       // amplitude over that of the first level
  std::uint32_t seed;
  Vec3f offset{};  // added to the coordinates in cells
};

// The noise of a level at a point.
ASTROLITH_KERNEL float sparse_noise(const SparseLevel& l, float probability, float inverse_probability,
                                    float x, float y, float z) {
  return upscaled_noise(math::fma(l.frequency, x, l.offset.x), math::fma(l.frequency, y, l.offset.y),
                        math::fma(l.frequency, z, l.offset.z), l.seed, probability, inverse_probability);
}

// Adds one level to the sum; and the height from the complete sum.
ASTROLITH_KERNEL float with_sparse_level(float gain, float noise, float cut, float sum) {
  return sum + gain * math::max(noise - cut, 0.0f);
}
ASTROLITH_KERNEL float sparse_height(float amplitude, float sum, float cut) {
  return -amplitude * math::max(sum - cut, 0.0f);
}

// The thresholds cut either each level (level_cut) or the sum of all levels (sum_cut). The other threshold is
// 0.
struct SparseNoise {
  static constexpr NoiseTraits kTraits{.on_surface = false,
                                       .lifts = false,
                                       .has_heights = true,
                                       .bounded_by_box = true,
                                       .local_form = false,
                                       .lists = NoiseLists::kNone};

  Vec3f low, high;  // points outside are moved to the border
  ArrayRange<SparseLevel> levels;
  float amplitude = 0.0f, level_cut = 0.0f, sum_cut = 0.0f;
  float probability = 0.0f, inverse_probability = 0.0f;
  double height_bound = 0.0;  // bound of |n(p)|, length units
  NoiseDetail detail;
};

// `layer_index` is the layer's number in the recipe; layers of one seed are independent. The domain of the
// frame holds the surface; points outside it are moved to its border. Levels too fine for float coordinates
// within the domain are left out.
SparseNoise make_noise(const SparseLayer& layer, std::uint64_t seed, int layer_index, const NoiseFrame& frame,
                       ArrayStore& arrays);

// The height n(p), length units.
ASTROLITH_HD inline float height_at(const SparseNoise& n, const ArrayView& arrays, const Vec3f& at) {
  const Vec3f p = moved_into(at, n.low, n.high);
  const SparseLevel* levels = arrays[n.levels];
  float sum = 0.0f;
  for (std::uint32_t l = 0; l < n.levels.count; ++l) {
    const SparseLevel& level = levels[l];
    const float noise = sparse_noise(level, n.probability, n.inverse_probability, p.x, p.y, p.z);
    sum = with_sparse_level(level.gain, noise, n.level_cut, sum);
  }
  return sparse_height(n.amplitude, sum, n.sum_cut);
}

// Writes height[i] = n(p_i), length units. The loop is vectorised and gives the same bits as height_at.
void evaluate_heights(const SparseNoise& n, const ArrayView& arrays, int count, const float* x,
                      const float* y, const float* z, float* height);

inline constexpr double kMostSparseCells = 512.0;  // largest number of cells that a bound visits
inline constexpr double kSparseSlack = 1e-5;       // relative slack for the rounding of positions and sums

// The greatest weight of a bump between low and high, in cells from its centre.
ASTROLITH_HD inline double greatest_bump(double low, double high) {
  const double d = std::max(std::max(0.0, low), -high);
  return d <= 0.5 ? 0.75 - d * d : d < 1.5 ? 0.5 * (1.5 - d) * (1.5 - d) : 0.0;
}

// An upper bound of one level over a box, before its threshold.
ASTROLITH_HD inline double greatest_sparse_noise(const SparseLevel& level, float probability,
                                                 float inverse_probability, const Box& box) {
  const double f = double{level.frequency};
  const double rounding = 1e-6 * (1.0 + f * largest_coordinate(box));
  const Vec3d offset{level.offset.x, level.offset.y, level.offset.z};
  const Vec3d low = f * box.min + offset - Vec3d{rounding, rounding, rounding},
              high = f * box.max + offset + Vec3d{rounding, rounding, rounding};
  const auto first = [](double c) { return std::floor(c + 0.5) - 1.0; };
  const auto last = [](double c) { return std::floor(c + 0.5) + 1.0; };
  const double cells = (last(high.x) - first(low.x) + 1.0) * (last(high.y) - first(low.y) + 1.0) *
                       (last(high.z) - first(low.z) + 1.0);
  if (!(cells <= kMostSparseCells)) return double{kInverseBumpHeight};
  double sum = 0.0;
  for (double k = first(low.z); k <= last(high.z); ++k) {
    const double wz = greatest_bump(low.z - k, high.z - k);
    for (double j = first(low.y); j <= last(high.y); ++j) {
      const double wy = greatest_bump(low.y - j, high.y - j);
      for (double i = first(low.x); i <= last(high.x); ++i) {
        sum += wz * wy * greatest_bump(low.x - i, high.x - i) *
               double{sparse_value(static_cast<float>(i), static_cast<float>(j), static_cast<float>(k),
                                   level.seed, probability, inverse_probability)};
      }
    }
  }
  return std::min(sum * (1.0 + kSparseSlack), 1.0) * double{kInverseBumpHeight};  // the weights add up to 1
}

// An interval that holds n(p) for every float point p of the box, length units.
ASTROLITH_HD inline Interval bound_heights(const SparseNoise& n, const ArrayView& arrays, const Box& box) {
  const Box inside = moved_into(box, n.low, n.high);
  const SparseLevel* levels = arrays[n.levels];
  double deepest = 0.0;
  for (std::uint32_t l = 0; l < n.levels.count; ++l) {
    const double noise = greatest_sparse_noise(levels[l], n.probability, n.inverse_probability, inside);
    deepest += double{levels[l].gain} * std::max(noise - double{n.level_cut}, 0.0);
  }
  deepest = std::max(deepest - double{n.sum_cut}, 0.0);
  const double slack = kSparseSlack * n.height_bound,
               reach = std::fabs(double{n.amplitude}) * deepest + slack;
  return n.amplitude > 0.0f ? Interval{-reach, slack} : Interval{-slack, reach};
}

}  // namespace astrolith
