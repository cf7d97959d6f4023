// Regions of a surface: what a permutation test exchanges, and how far roughness differs between them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace astrolith {

inline constexpr int kRegions = 40;
// Groups of five neighbouring regions, which a permutation test exchanges as one: places on both sides of a
// border resemble one another, and within a group there are few borders to others.
inline constexpr int kRegionGroups = 8;
using RegionGroups = std::array<std::uint8_t, kRegions>;

// Ranges of distance between two places, in edges.
struct LagRange {
  double low, high;
};
inline constexpr std::array<LagRange, 3> kCovarianceLags{{{6, 10}, {10, 16}, {16, 28}}};

// The sum of products of a value's deviations from its mean, over pairs of places, and the number of pairs.
struct PairSum {
  double products = 0.0, pairs = 0.0;
};

struct Regions {
  std::vector<std::uint8_t> region_index;  // (#places) number of the region, below kRegions
  RegionGroups groups{};                   // of the regions, below kRegionGroups
  double variance = 0.0;                   // of the value over all places
  double between = 0.0;                    // variance of the regions' means
  // The pairs at each lag whose places lie in one region. Pairs of two regions would be torn when regions are
  // exchanged, which would make the test reject too often.
  std::array<std::array<PairSum, kCovarianceLags.size()>, kRegions> pairs{};

  // The covariance at a lag over the variance: 1 for places that are alike, 0 for independent ones.
  double correlation(std::size_t lag) const;
};

// Parts the places among the kRegions points of a Poisson disk on the mesh, each to the nearest.
std::vector<std::uint8_t> find_regions(const TriangleMesh& mesh, std::span<const Vec3d> places,
                                       std::uint64_t seed);

// The group of each region. The regions are halved three times along the longest axis of their centres, which
// are the means of their places.
RegionGroups region_groups(std::span<const std::uint8_t> region_index, std::span<const Vec3d> places);

// The sums of a value over the regions.  values: (#places)
Regions regional_sums(std::vector<std::uint8_t> region_index, std::span<const Vec3d> places,
                      std::span<const double> values, double edge);

}  // namespace astrolith
