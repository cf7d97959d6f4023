#include "descriptor/surface/block_permutations.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "numerics/hash_random.h"

namespace astrolith {

RegionLabels own_regions() {
  RegionLabels labels{};
  std::fill_n(labels.begin(), kRegions, true);
  return labels;
}

RegionLabels exchanged_regions(const RegionGroups& of_first, const RegionGroups& of_second,
                               std::uint64_t seed, std::uint64_t k) {
  std::array<bool, 2 * kRegionGroups> is_first{};
  std::fill_n(is_first.begin(), kRegionGroups, true);
  CounterRandom random(seed, k);
  for (std::size_t i = 0; i < kRegionGroups; ++i) {
    std::swap(is_first[i], is_first[i + random.below(is_first.size() - i)]);
  }
  RegionLabels labels{};
  for (std::size_t r = 0; r < kRegions; ++r) {
    labels[r] = is_first[of_first[r]];
    labels[r + kRegions] = is_first[of_second[r] + std::size_t{kRegionGroups}];
  }
  return labels;
}

KolmogorovSmirnov::KolmogorovSmirnov(const RegionalValues& a, const RegionalValues& b) {
  sorted_.reserve(a.values.size() + b.values.size());
  for (std::size_t i = 0; i < a.values.size(); ++i) sorted_.push_back({a.values[i], a.regions[i]});
  for (std::size_t i = 0; i < b.values.size(); ++i) {
    sorted_.push_back({b.values[i], static_cast<std::uint8_t>(b.regions[i] + kRegions)});
  }
  std::stable_sort(sorted_.begin(), sorted_.end(),
                   [](const Entry& x, const Entry& y) { return x.value < y.value; });
}

double KolmogorovSmirnov::operator()(const RegionLabels& first) const {
  std::int64_t firsts = 0;
  for (const Entry& e : sorted_) firsts += first[e.region] ? 1 : 0;
  const std::int64_t others = static_cast<std::int64_t>(sorted_.size()) - firsts;
  if (firsts == 0 || others == 0) return 0.0;
  // Counts of both samples up to a value, each times the size of the other sample: whole numbers.
  std::int64_t difference = 0, largest = 0;
  for (std::size_t i = 0; i < sorted_.size(); ++i) {
    difference += first[sorted_[i].region] ? others : -firsts;
    const bool last_of_equals = i + 1 == sorted_.size() || sorted_[i].value < sorted_[i + 1].value;
    if (last_of_equals) largest = std::max(largest, std::abs(difference));
  }
  return static_cast<double>(largest) / (static_cast<double>(firsts) * static_cast<double>(others));
}

CovarianceDifference::CovarianceDifference(const Regions& a, const Regions& b, std::size_t lag)
    : variance_(0.5 * (a.variance + b.variance)) {
  for (std::size_t r = 0; r < kRegions; ++r) {
    sums_[r] = a.pairs[r][lag];
    sums_[r + kRegions] = b.pairs[r][lag];
  }
}

double CovarianceDifference::operator()(const RegionLabels& first) const {
  std::array<PairSum, 2> totals{};
  for (std::size_t r = 0; r < sums_.size(); ++r) {
    PairSum& total = totals[first[r] ? 0 : 1];
    total.products += sums_[r].products;
    total.pairs += sums_[r].pairs;
  }
  if (!(totals[0].pairs > 0.0) || !(totals[1].pairs > 0.0) || !(variance_ > 0.0)) return 0.0;
  return std::fabs(totals[0].products / totals[0].pairs - totals[1].products / totals[1].pairs) / variance_;
}

}  // namespace astrolith
