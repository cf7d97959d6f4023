#include "numerics/sample_statistics.h"

#include <gtest/gtest.h>

namespace astrolith {
namespace {

TEST(RankedValue, IsTheOneAtItsPlaceOfTheSortedValues) {
  const std::vector<double> values{4.0, -5.0, 1.0, 3.0, -2.0, 1.0};
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t rank = 0; rank < sorted.size(); ++rank) {
    EXPECT_EQ(ranked_value(values, rank), sorted[rank]) << rank;
  }
}

TEST(SampleStatistics, MeanAndVariance) {
  EXPECT_EQ(mean_of(std::vector<float>{1.0f, 2.0f, 6.0f}), 3.0);
  EXPECT_EQ(variance_of(std::vector<double>{1.0, 3.0}), 1.0);
  EXPECT_EQ(variance_of(std::vector<double>{}), 0.0);
  EXPECT_EQ(sum_of_products(std::vector<double>{1.0, 2.0}, std::vector<double>{3.0, 4.0}), 11.0);
}

TEST(RankedValue, MediansAreTheUpperOfTwo) {
  EXPECT_EQ(upper_median(std::vector<float>{3.0f, 1.0f, 2.0f}), 2.0f);
  EXPECT_EQ(upper_median(std::vector<double>{4.0, 1.0, 3.0, 2.0}), 3.0);
  EXPECT_EQ(median_magnitude({-4.0, 1.0, -3.0, 2.0}), 3.0);
}

}  // namespace
}  // namespace astrolith
