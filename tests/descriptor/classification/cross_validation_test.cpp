#include "descriptor/classification/cross_validation.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "tests/descriptor/classification/clusters.h"

namespace astrolith {
namespace {

using testing::clusters;

TEST(StratifiedFolds, HoldEveryClassInEqualShares) {
  std::vector<int> labels(14, 0);
  labels.insert(labels.end(), 13, 1);
  labels.insert(labels.end(), 5, 2);
  const std::vector<int> folds = stratified_folds(labels, 3, 5, 1);
  for (int c = 0; c < 3; ++c) {
    const auto of_class = std::count(labels.begin(), labels.end(), c);
    for (int fold = 0; fold < 5; ++fold) {
      std::int64_t both = 0;
      for (std::size_t i = 0; i < labels.size(); ++i) both += labels[i] == c && folds[i] == fold ? 1 : 0;
      EXPECT_GE(both, of_class / 5);
      EXPECT_LE(both, (of_class + 4) / 5);
    }
  }
  for (int fold = 0; fold < 5; ++fold) {
    EXPECT_GE(std::count(folds.begin(), folds.end(), fold), 32 / 5);
    EXPECT_LE(std::count(folds.begin(), folds.end(), fold), (32 + 4) / 5);
  }
  EXPECT_NE(folds, stratified_folds(labels, 3, 5, 2));
}

TEST(CrossValidation, TellsClustersApart) {
  const LabelledFeatures data = clusters(3, 12, 8, 0.15, 1);
  for (const int components : {0, 2}) {
    const VoteRows votes = cross_validate(data, {components, {40, 25, 1}}, 4, 1);
    EXPECT_GE(evaluate(votes, data.labels, 3).accuracy, 0.95);
  }
}

// If a classifier had learned from a shape, it would find that shape's meaningless label again.
TEST(CrossValidation, DoesNotKnowWhatItIsAskedFor) {
  LabelledFeatures data = clusters(1, 120, 10, 1, 1);
  data.classes = {"heads", "tails"};
  CounterRandom random(7);
  for (int& label : data.labels) label = static_cast<int>(random.below(2));
  const VoteRows votes = cross_validate(data, {0, {50, 25, 1}}, 5, 1);
  EXPECT_NEAR(evaluate(votes, data.labels, 2).accuracy, 0.5, 0.15);
}

TEST(CrossValidation, SameVotesForAnyThreadCount) {
  const LabelledFeatures data = clusters(3, 15, 30, 1, 1);
  const TrainingOptions options{3, {20, 25, 1}};
  const VoteRows all = cross_validate(data, options, 5, 1);
  const ThreadLimit one(1);
  EXPECT_EQ(cross_validate(data, options, 5, 1), all);
}

TEST(CrossValidation, StopsWhenAsked) {
  const LabelledFeatures data = clusters(2, 10, 3, 0.2, 1);
  EXPECT_THROW(cross_validate(data, {0, {5, 25, 1}}, 5, 1, [](double, std::string_view) { return false; }),
               WorkError);
}

TEST(CrossValidation, RefusesTooFewShapes) {
  LabelledFeatures data = clusters(2, 5, 3, 0.2, 1);
  EXPECT_THROW(cross_validate(data, {}, 1, 1), InputError);
  EXPECT_THROW(cross_validate(data, {}, 11, 1), InputError);
  data.classes.push_back("alone");
  EXPECT_THROW(cross_validate(data, {}, 2, 1), InputError);
}

}  // namespace
}  // namespace astrolith
