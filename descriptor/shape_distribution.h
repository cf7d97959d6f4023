// The D2 shape distribution: the distribution of the distance between two random points of a surface.
//
// Osada, Funkhouser, Chazelle and Dobkin, "Shape distributions", ACM Transactions on Graphics 2002. They draw
// 1024^2 random pairs. Here every unordered pair of an even sampling counts, so that no random numbers are
// needed besides those of the sampling. Distances are divided by their mean, one of the two normalisations
// that they compare.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "numerics/vec3.h"

namespace astrolith {

// Bins cover [0, 3) means. A straight rod, the most elongated of all even bodies, ends at 3. Longer distances
// count in the last bin.
inline constexpr double kDistributionReach = 3.0;

struct ShapeDistribution {
  std::vector<std::uint64_t> counts;  // (bins)
  std::uint64_t pairs = 0;            // sum of the counts: n (n - 1) / 2
  double mean_distance = 0;           // in the unit of the points

  // (bins) counts / pairs.
  std::vector<double> frequencies() const;
};

// Counts all pairs, in time O(n^2); the counts do not depend on the number of threads. Throws InputError for
// fewer than 2 or more than 2^24 points, for numbers that are not finite, for points that are all in one
// place, and unless 1 <= bins <= 65536.
ShapeDistribution shape_distribution(std::span<const Vec3d> points, int bins);

}  // namespace astrolith
