#include "descriptor/classification/retrieval.h"

#include <gtest/gtest.h>

#include <cmath>

#include "numerics/parallel_for.h"
#include "tests/descriptor/classification/clusters.h"

namespace astrolith {
namespace {

double distance(std::span<const float> f, std::span<const float> g) { return std::fabs(f[0] - g[0]); }

TEST(Retrieval, OfShapesOnALine) {
  // Shapes 0 and 1 have class 0, shapes 10 and 2 have class 1. Shape 0 asks and finds 1, 2, 10; shape 10 asks
  // and finds 2, 1, 0; and so on.
  const FeatureRows rows{{0}, {1}, {10}, {2.5}};
  const std::vector<int> labels{0, 0, 1, 1};
  const Retrieval r = retrieve(rows, labels, distance);
  // The precision at the one relevant shape is 1, 1, 1, 1/3 (2.5 finds 1, 0, 10).
  EXPECT_NEAR(r.mean_average_precision, (3 + 1.0 / 3) / 4, 1e-12);
  EXPECT_NEAR(r.nearest_accuracy, 0.75, 1e-12);
  EXPECT_NEAR(r.curve[20], r.mean_average_precision, 1e-12);
}

TEST(Retrieval, ShapesWithoutCompanyDoNotAsk) {
  const Retrieval r = retrieve({{0}, {1}, {5}}, std::vector<int>{0, 0, 1}, distance);
  EXPECT_EQ(r.mean_average_precision, 1);
  EXPECT_EQ(r.nearest_accuracy, 1);
  EXPECT_EQ(retrieve({{0}}, std::vector<int>{0}, distance).mean_average_precision, 0);
}

TEST(Retrieval, SameBitsForAnyThreadCount) {
  const LabelledFeatures data = testing::clusters(4, 30, 3, 0.7, 1);
  const Retrieval all = retrieve(data.rows, data.labels, distance);
  const ThreadLimit one(1);
  const Retrieval single = retrieve(data.rows, data.labels, distance);
  EXPECT_EQ(all.mean_average_precision, single.mean_average_precision);
  EXPECT_EQ(all.curve, single.curve);
}

}  // namespace
}  // namespace astrolith
