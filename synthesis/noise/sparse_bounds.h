// What is certain about sparse noise over a box, for CPU and GPU.
#pragma once

#include "numerics/interval.h"
#include "synthesis/noise/sparse_noise.h"

namespace astrolith {

inline constexpr double kMostSparseCells = 512.0;  // looked at one by one
inline constexpr double kSparseSlack = 1e-5;       // relative, for the rounding of positions and sums

// The greatest weight that a cell's bump has from low to high, in cells from its centre.
ASTROLITH_HD inline double greatest_bump(double low, double high) {
  const double d = std::max(std::max(0.0, low), -high);
  return d <= 0.5 ? 0.75 - d * d : d < 1.5 ? 0.5 * (1.5 - d) * (1.5 - d) : 0.0;
}

// Of one level.
ASTROLITH_HD inline double greatest_sparse_noise(const SparseLevel& level, float probability,
                                                 float inverse_probability, const Box& box) {
  const double f = double{level.frequency};
  const double rounding = 1e-6 * (1.0 + f * largest_coordinate(box));
  const Vec3d low = f * box.min - Vec3d{rounding, rounding, rounding},
              high = f * box.max + Vec3d{rounding, rounding, rounding};
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

// From the noise's parts, of which either the levels or their sum is cut; `height_bound` is of the heights
// everywhere.
ASTROLITH_HD inline Interval bound_sparse_heights(const SparseLevel* levels, std::uint32_t count,
                                                  float probability, float inverse_probability,
                                                  float amplitude, float level_cut, float sum_cut,
                                                  double height_bound, const Box& box) {
  double deepest = 0.0;
  for (std::uint32_t l = 0; l < count; ++l) {
    const double noise = greatest_sparse_noise(levels[l], probability, inverse_probability, box);
    deepest += double{levels[l].gain} * std::max(noise - double{level_cut}, 0.0);
  }
  deepest = std::max(deepest - double{sum_cut}, 0.0);
  const double slack = kSparseSlack * height_bound, reach = std::fabs(double{amplitude}) * deepest + slack;
  return amplitude > 0.0f ? Interval{-reach, slack} : Interval{-slack, reach};
}

}  // namespace astrolith
