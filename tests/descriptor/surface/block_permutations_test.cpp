#include "descriptor/surface/realism.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "numerics/hash_random.h"

namespace astrolith {
namespace {

using Values = std::vector<double>;

constexpr RegionGroups kGroups = [] {
  RegionGroups groups{};
  for (std::size_t r = 0; r < groups.size(); ++r) {
    groups[r] = static_cast<std::uint8_t>(r % static_cast<std::size_t>(kRegionGroups));
  }
  return groups;
}();

TEST(KolmogorovSmirnovDistance, OfSamplesWithKnownDistances) {
  const std::vector<std::uint8_t> region(4, 0);
  const auto distance = [&](const Values& a, const Values& b) {
    return KolmogorovSmirnov({a, std::span(region).first(a.size())},
                             {b, std::span(region).first(b.size())})(own_regions());
  };
  EXPECT_EQ(distance({1, 2, 3}, {4, 5, 6, 7}), 1);
  EXPECT_EQ(distance({1, 2, 3, 4}, {3, 4, 5, 6}), 0.5);
  EXPECT_EQ(distance({1, 2, 2, 3}, {1, 2, 2, 3}), 0);
  EXPECT_EQ(distance({1, 1, 1, 2}, {1, 2}), 0.25);
  EXPECT_EQ(distance({5}, {5, 5, 5}), 0);
}

TEST(ExchangedRegions, KeepTheirNumber) {
  RegionLabels together{};
  for (std::uint64_t k = 0; k < 50; ++k) {
    const RegionLabels labels = exchanged_regions(kGroups, kGroups, 3, k);
    EXPECT_EQ(std::count(labels.begin(), labels.end(), true), kRegions);
    EXPECT_EQ(labels, exchanged_regions(kGroups, kGroups, 3, k));
    for (std::size_t r = 0; r < labels.size(); ++r) together[r] = together[r] || labels[r];
  }
  EXPECT_EQ(std::count(together.begin(), together.end(), true), 2 * kRegions);
}

TEST(ExchangedRegions, KeepGroupsTogether) {
  for (std::uint64_t k = 0; k < 20; ++k) {
    const RegionLabels labels = exchanged_regions(kGroups, kGroups, 4, k);
    for (std::size_t r = 0; r < labels.size(); ++r) {
      EXPECT_EQ(labels[r], labels[r / kRegions * kRegions + kGroups[r % kRegions]]);
    }
  }
}

TEST(RegionGroups, HaveFiveNeighbouringRegionsEach) {
  std::vector<std::uint8_t> regions;
  std::vector<Vec3d> places;
  for (int r = 0; r < kRegions; ++r) {  // eight clusters of five regions, numbered across the clusters
    const int cluster = r % 8;
    regions.push_back(static_cast<std::uint8_t>(r));
    places.push_back({10.0 * (cluster & 1), 6.0 * (cluster >> 1 & 1), 3.0 * (cluster >> 2) + 0.1 * (r / 8)});
  }
  const RegionGroups groups = region_groups(regions, places);
  for (std::size_t r = 8; r < groups.size(); ++r) EXPECT_EQ(groups[r], groups[r % 8]);
  for (int g = 0; g < kRegionGroups; ++g) EXPECT_EQ(std::count(groups.begin(), groups.end(), g), 5);
}

struct Sample {
  Values values;
  std::vector<std::uint8_t> regions;
};
Sample random_sample(std::size_t n, double shift, std::uint64_t seed) {
  CounterRandom random(seed, 0);
  Sample sample;
  for (std::size_t i = 0; i < n; ++i) {
    // Rounded, so that values repeat.
    sample.values.push_back(std::round(8 * random.normal() + shift));
    sample.regions.push_back(static_cast<std::uint8_t>(random.below(kRegions)));
  }
  return sample;
}

// The definition: the difference of the distribution functions at every value.
double by_definition(const Values& a, const Values& b) {
  double largest = 0;
  const auto up_to = [](const Values& v, double x) {
    return static_cast<double>(std::count_if(v.begin(), v.end(), [&](double y) { return y <= x; })) /
           static_cast<double>(v.size());
  };
  for (const Values* sample : {&a, &b}) {
    for (const double x : *sample) largest = std::max(largest, std::fabs(up_to(a, x) - up_to(b, x)));
  }
  return largest;
}

TEST(KolmogorovSmirnov, WithExchangedRegionsFollowsTheDefinition) {
  const Sample a = random_sample(300, 0, 1), b = random_sample(250, 3, 2);
  const KolmogorovSmirnov test({a.values, a.regions}, {b.values, b.regions});
  EXPECT_NEAR(test(own_regions()), by_definition(a.values, b.values), 1e-14);
  for (std::uint64_t k = 0; k < 10; ++k) {
    const RegionLabels labels = exchanged_regions(kGroups, kGroups, 5, k);
    Values first, second;
    for (std::size_t i = 0; i < a.values.size(); ++i) {
      (labels[a.regions[i]] ? first : second).push_back(a.values[i]);
    }
    for (std::size_t i = 0; i < b.values.size(); ++i) {
      (labels[b.regions[i] + std::size_t{kRegions}] ? first : second).push_back(b.values[i]);
    }
    EXPECT_NEAR(test(labels), by_definition(first, second), 1e-14);
  }
}

TEST(CovarianceDifference, OfOwnRegionsIsThatOfTheCorrelations) {
  CounterRandom random(9, 0);
  Sample a = random_sample(400, 0, 4), b = random_sample(400, 0, 5);
  std::vector<Vec3d> places;
  for (int i = 0; i < 400; ++i) places.push_back({30 * random.uniform(), 30 * random.uniform(), 0});
  // Values that go together with the place are correlated; the variances are made equal.
  for (std::size_t i = 0; i < 400; ++i) a.values[i] = places[i].x;
  b.values = a.values;
  std::reverse(b.values.begin(), b.values.end());
  const Regions ra = regional_sums(a.regions, places, a.values, 1),
                rb = regional_sums(b.regions, places, b.values, 1);
  EXPECT_GT(ra.correlation(0), 0.4);
  EXPECT_LT(std::fabs(rb.correlation(0)), 0.25);
  EXPECT_NEAR(CovarianceDifference(ra, rb, 0)(own_regions()),
              std::fabs(ra.correlation(0) - rb.correlation(0)), 1e-12);
}

}  // namespace
}  // namespace astrolith
