// The D2 shape distribution: how the distances between two random points of a surface are spread.
//
// Osada, Funkhouser, Chazelle and Dobkin, "Shape distributions", ACM Transactions on Graphics 2002. They draw
// 1024^2 random pairs; here every unordered pair of an even sampling counts, which needs no random numbers
// beyond the sampling's own. Distances are divided by their mean, one of the two normalisations they compare.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "numerics/vec3.h"

namespace astrolith {

// Bins cover [0, 3) means: a straight rod, the most drawn out of all even bodies, ends at 3. What is longer
// counts in the last bin.
inline constexpr double kDistributionReach = 3.0;

struct ShapeDistribution {
  std::vector<std::uint64_t> counts;  // (bins)
  std::uint64_t pairs = 0;            // sum of counts: n (n - 1) / 2
  double mean_distance = 0;           // in the points' unit

  // (bins) counts / pairs.
  std::vector<double> frequencies() const;
};

// Time O(n^2); any thread count gives the same counts. Throws InputError for fewer than 2 or more than 2^24
// points, for numbers that are not finite, for points that are all in one place, and unless 1 <= bins <=
// 65536.
ShapeDistribution shape_distribution(std::span<const Vec3d> points, int bins);

}  // namespace astrolith
