// A shape's fingerprint: how often each combination of features occurs among all pairs of its points.
#pragma once

#include <cstdint>
#include <vector>

namespace astrolith {

enum class PairFeatures {
  wahl,  // alpha, beta, gamma, delta of descriptor/surflet_pair.h
  ahd    // these, and eta and kappa of the pair's origin, descriptor/local_features.h
};

constexpr int dimensions(PairFeatures features) { return features == PairFeatures::wahl ? 4 : 6; }

// bins^dimensions: 625 and 15,625 for five bins.
constexpr std::int64_t bin_count(PairFeatures features, int bins) {
  std::int64_t count = 1;
  for (int d = 0; d < dimensions(features); ++d) count *= bins;
  return count;
}

inline constexpr int kDefaultBins = 5;
inline constexpr int kMinBins = 2, kMaxBins = 10;

struct ShapeHistogram {
  PairFeatures features = PairFeatures::wahl;
  int bins = kDefaultBins;            // an axis
  std::vector<std::uint64_t> counts;  // (bins, ... , bins) row-major: alpha beta gamma delta [eta kappa]
  std::uint64_t pairs = 0;            // sum of counts: n (n - 1) / 2
  double max_distance = 0;            // that delta is a fraction of, in the points' unit

  // As counts, divided by pairs; zeros when there are no pairs.
  std::vector<double> frequencies() const;
};

}  // namespace astrolith
