// Differences between two surfaces as functions of which regions belong to which surface. A permutation test
// exchanges whole groups of regions: neighbouring places resemble one another and are not independent.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "descriptor/surface/regions.h"

namespace astrolith {

// Whether each region counts to the first sample: those of the first surface, then those of the second.
using RegionLabels = std::array<bool, 2 * kRegions>;

// The labels as the surfaces are.
RegionLabels own_regions();
// The k-th random choice of kRegionGroups of all groups for the first sample, which has kRegions regions
// then.
RegionLabels exchanged_regions(const RegionGroups& of_first, const RegionGroups& of_second,
                               std::uint64_t seed, std::uint64_t k);

// Values at places, each with the region of its place.
struct RegionalValues {
  std::span<const double> values;
  std::span<const std::uint8_t> regions;  // as many
};

// The Kolmogorov-Smirnov distance: the largest difference of the two distribution functions, 0 to 1. Neither
// sample is empty.
class KolmogorovSmirnov {
 public:
  KolmogorovSmirnov(const RegionalValues& a, const RegionalValues& b);
  // The distance of the samples that the labels make; 0 where one is empty.
  double operator()(const RegionLabels& first) const;

 private:
  struct Entry {
    double value;
    std::uint8_t region;  // of the second surface: from kRegions
  };
  std::vector<Entry> sorted_;
};

// The difference of two surfaces' covariances at a lag, over the mean of their variances.
class CovarianceDifference {
 public:
  CovarianceDifference(const Regions& a, const Regions& b, std::size_t lag);
  double operator()(const RegionLabels& first) const;

 private:
  std::array<PairSum, 2 * kRegions> sums_{};
  double variance_ = 0.0;
};

}  // namespace astrolith
