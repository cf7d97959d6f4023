#include <array>

#include "numerics/hash_random.h"
#include "numerics/sample_statistics.h"

namespace astrolith {
namespace {

TEST(HashRandom, PinnedValues) {
  // These values define the meaning of recipes: changing them changes every synthesised mesh.
  EXPECT_EQ(mix_bits(1u), 1753845952u);
  EXPECT_EQ(hash_cell(hash_seed(42, 3), -1, 2, 5), hash_cell(hash_seed(42, 3), -1, 2, 5));
  EXPECT_NE(hash_cell(hash_seed(42, 3), -1, 2, 5), hash_cell(hash_seed(42, 3), 2, -1, 5));
  EXPECT_NE(hash_seed(1, 0), hash_seed(std::uint64_t{1} << 32, 0));
}

TEST(HashRandom, UnitFloatStaysBelowOne) {
  EXPECT_EQ(unit_float(0u), 0.0f);
  EXPECT_LT(unit_float(0xffffffffu), 1.0f);
}

// Chi-square over 4096 buckets of the hashes of neighbouring cells: mean 4095, standard deviation 90.
TEST(HashRandom, NeighbouringCellsAreUniform) {
  std::array<int, 4096> counts{};
  const int side = 128;
  for (int x = 0; x < side; ++x)
    for (int y = 0; y < side; ++y)
      for (int z = 0; z < 16; ++z) ++counts[hash_cell(7u, x, y, z) >> 20];
  const double expected = side * side * 16 / 4096.0;
  double chi2 = 0;
  for (int c : counts) chi2 += (c - expected) * (c - expected) / expected;
  EXPECT_NEAR(chi2, 4095, 5 * 90);
}

TEST(CounterRandom, MomentsOfUniformAndNormal) {
  CounterRandom random(5);
  double sum = 0, sum2 = 0, sum4 = 0;
  const int n = 400000;
  for (int i = 0; i < n; ++i) {
    const double g = random.normal();
    sum += g;
    sum2 += g * g;
    sum4 += g * g * g * g;
  }
  EXPECT_NEAR(sum / n, 0.0, 5 / std::sqrt(n));
  EXPECT_NEAR(sum2 / n, 1.0, 5 * std::sqrt(2.0 / n));
  EXPECT_NEAR(sum4 / n, 3.0, 5 * std::sqrt(96.0 / n));
}

TEST(CounterRandom, StreamsAndSeedsDiffer) {
  EXPECT_NE(CounterRandom(1, 0).next(), CounterRandom(1, 1).next());
  EXPECT_NE(CounterRandom(1, 0).next(), CounterRandom(2, 0).next());
  EXPECT_EQ(CounterRandom(1, 7).next(), CounterRandom(1, 7).next());
  CounterRandom random(3);
  for (int i = 0; i < 1000; ++i) ASSERT_LT(random.below(7), 7u);
}

TEST(RankedValue, IsTheOneAtItsPlaceOfTheSortedValues) {
  const std::vector<double> values{4.0, -5.0, 1.0, 3.0, -2.0, 1.0};
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t rank = 0; rank < sorted.size(); ++rank) {
    EXPECT_EQ(ranked_value(values, rank), sorted[rank]) << rank;
  }
}

TEST(SampleStatistics, MeanAndVariance) {
  EXPECT_EQ(sample_mean(std::vector<float>{1.0f, 2.0f, 6.0f}), 3.0);
  EXPECT_EQ(sample_variance(std::vector<double>{1.0, 3.0}), 1.0);
  EXPECT_EQ(sample_variance(std::vector<double>{}), 0.0);
  EXPECT_EQ(dot_product(std::vector<double>{1.0, 2.0}, std::vector<double>{3.0, 4.0}), 11.0);
}

TEST(RankedValue, MediansAreTheUpperOfTwo) {
  EXPECT_EQ(upper_median(std::vector<float>{3.0f, 1.0f, 2.0f}), 2.0f);
  EXPECT_EQ(upper_median(std::vector<double>{4.0, 1.0, 3.0, 2.0}), 3.0);
  EXPECT_EQ(median_magnitude({-4.0, 1.0, -3.0, 2.0}), 3.0);
}

}  // namespace
}  // namespace astrolith
