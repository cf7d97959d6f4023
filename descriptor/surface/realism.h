// Whether one surface passes for another, by their local statistics. A permutation test exchanges whole
// groups of regions between them: neighbouring places resemble one another and are not independent.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "descriptor/surface/regions.h"
#include "descriptor/surface/surface_statistics.h"
#include "numerics/progress.h"

namespace astrolith {

// Whether each region counts to the first sample: those of the first surface, then those of the second.
using RegionLabels = std::array<bool, 2 * kRegions>;

// The labels as the surfaces are.
RegionLabels own_regions();
// The k-th random choice of kRegionGroups of all groups for the first sample, which has kRegions regions
// then.
RegionLabels exchanged_regions(const RegionGroups& first_groups, const RegionGroups& second_groups,
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

inline constexpr double kPassingP = 0.05, kPassingDistance = 0.13;

// Below so many points the test seldom notices that all relief is gone (docs/surfaces.md).
inline constexpr std::int64_t kFewestJudged = 1400;

// The difference of two surfaces in one statistic.
struct StatisticComparison {
  SurfaceQuantity quantity = SurfaceQuantity::roughness;
  // A correlation of roughness over distance in place of a distribution; `radius` is then the least distance
  // and `reach` the largest.
  bool correlation = false;
  double radius = 0.0, reach = 0.0;  // edges
  double distance = 0.0;             // Kolmogorov-Smirnov; of correlations their difference
  double p = 1.0;                    // share of exchanges with a distance at least as large
  // Whether the statistic counts in the verdict's p, and in its largest distance. Others are stated only.
  bool counts_in_p = false, counts_in_distance = false;
  // Medians and interquartile ranges of both distributions, for skewness the means; for a correlation its two
  // values and 0.
  double middle_a = 0.0, middle_b = 0.0, spread_a = 0.0, spread_b = 0.0;
  bool differs() const {
    return (counts_in_p && p < kPassingP) || (counts_in_distance && distance > kPassingDistance);
  }
};

// How high the relief of one scale is beside that of the first surface.
struct BandRatio {
  double from = 0.0, to = 0.0;  // edges
  double ratio = 1.0;           // rms of the heights, b over a
};
// Where ratios are as wanted. They do not change the verdict.
inline constexpr double kWantedBandRatio[] = {0.85, 1.15}, kWantedCouplingRatio = 0.9;

struct RealismVerdict {
  // p >= kPassingP and largest_distance <= kPassingDistance, of surfaces that are not too coarse.
  bool passes = false;
  // Where the second surface has other parts or handles than the first, both in words: it does not pass then.
  std::string other_topology;
  // The surfaces have fewer points than kFewestJudged, and the test found no difference, which says nothing.
  bool too_coarse = false;
  std::int64_t points = 0;        // that each surface was evened to
  double p = 1.0;                 // of the whole
  double largest_distance = 0.0;  // of the statistics that count in it
  double variance_ratio = 0.0;    // of roughness between regions, b over a; 0 where a has none
  double edge = 0.0;              // of the first surface, its unit
  std::vector<StatisticComparison> statistics;
  std::vector<BandRatio> bands;          // those that both surfaces have (height_bands.h)
  std::optional<double> coupling_ratio;  // b over a, where both have a coupling and that of a is above 0

  // The statistic of the largest distance; none where no distance counts.
  const StatisticComparison* farthest() const;
};

struct RealismOptions {
  int permutations = 999;  // 19 to 99,999
  std::uint64_t seed = 1;
};

// The distances alone, without a test: for a search, some milliseconds. `p` stays 1. Both surfaces have the
// same points and radii, else InputError.
std::vector<StatisticComparison> statistic_distances(const SurfaceStatistics& a, const SurfaceStatistics& b);

// The largest distance among those that count.
double largest_distance(std::span<const StatisticComparison> statistics);

// Tests whether both surfaces could be two draws of one kind. Under that hypothesis groups of regions can be
// exchanged between them. p of a statistic is (1 + the number of permutations with at least its distance) /
// (1 + permutations). The whole is tested by the largest ratio of a distance to its own 95 % quantile over
// the permutations. A statistic counts in p where 40 regions hold its radius, and in the largest distance
// where 100 discs of the radius find room on the body. A test by regions is lenient on bodies that vary much,
// which is why a surface passes by p and by distance. Throws as statistic_distances() does, InputError for
// options out of range, and WorkError when progress asks to stop.
RealismVerdict judge_realism(const SurfaceStatistics& a, const SurfaceStatistics& b,
                             const RealismOptions& options, const Progress& progress = {});

// The medians of several verdicts on one first surface, as of several seeds of a noise. Not empty.
RealismVerdict median_verdict(std::span<const RealismVerdict> verdicts);

// How lengths are put into words: times `scale`, followed by the unit.
struct LengthWords {
  double scale = 1.0;
  std::string unit = "units";
};

// A length of so many edges without its unit, to two digits: "0.11", "690", "1400".
std::string length_in_words(double edges, const RealismVerdict& verdict, const LengthWords& lengths);

// What a reader should know: "passes", "too coarse to judge: ...", or what the second surface lacks beside
// the first: "too smooth between 8 and 20 m", "no boulders".
std::vector<std::string> realism_words(const RealismVerdict& verdict, const LengthWords& lengths);

// The bands and the coupling whose ratios are not as wanted, one line each. The test of realism sees neither.
std::vector<std::string> band_words(const RealismVerdict& verdict, const LengthWords& lengths);

}  // namespace astrolith
