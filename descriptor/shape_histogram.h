// The histogram that describes a shape: how often each combination of features occurs among all pairs of its
// points.
#pragma once

#include <cstdint>
#include <vector>

namespace astrolith {

enum class PairFeatures {
  wahl,  // alpha, beta, gamma, delta of descriptor/surflet_pair.h
  ahd    // the four of wahl, and eta and kappa of the pair's origin, descriptor/local_features.h
};

constexpr int dimensions(PairFeatures features) { return features == PairFeatures::wahl ? 4 : 6; }

// The number of bins, bins^dimensions: 625 (wahl) or 15,625 (ahd) for five bins along each axis.
constexpr std::int64_t bin_count(PairFeatures features, int bins) {
  std::int64_t count = 1;
  for (int d = 0; d < dimensions(features); ++d) count *= bins;
  return count;
}

inline constexpr int kDefaultBins = 5;
inline constexpr int kMinBins = 2, kMaxBins = 10;

// count.operator()<bins>() for kMinBins <= bins <= kMaxBins, which the compiler then knows.
template <int kBins = kMinBins, typename Count>
auto with_bins(int bins, const Count& count) {
  if constexpr (kBins < kMaxBins) {
    if (bins != kBins) return with_bins<kBins + 1>(bins, count);
  }
  return count.template operator()<kBins>();
}

struct ShapeHistogram {
  PairFeatures features = PairFeatures::wahl;
  int bins = kDefaultBins;            // along each axis
  std::vector<std::uint64_t> counts;  // (bins, ... , bins) row-major: alpha beta gamma delta [eta kappa]
  std::uint64_t pairs = 0;            // sum of counts: n (n - 1) / 2
  double max_distance = 0;            // delta = 1 stands for it; in the unit of the points

  // The counts divided by the number of pairs; zeros where there are no pairs.
  std::vector<double> frequencies() const;
};

}  // namespace astrolith
