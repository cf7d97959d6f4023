#include "descriptor/classification/random_forest.h"

#include <gtest/gtest.h>

#include <numeric>
#include <opencv2/ml.hpp>

#include "descriptor/classification/forest_conversion_internal.h"
#include "descriptor/classification/row_matrix_internal.h"
#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "tests/descriptor/classification/clusters.h"

namespace astrolith {
namespace {

using testing::clusters;

bool same(const RandomForest& a, const RandomForest& b) {
  if (a.trees.size() != b.trees.size()) return false;
  for (std::size_t t = 0; t < a.trees.size(); ++t) {
    if (a.trees[t].size() != b.trees[t].size()) return false;
    for (std::size_t i = 0; i < a.trees[t].size(); ++i) {
      const TreeNode &m = a.trees[t][i], &n = b.trees[t][i];
      if (m.feature != n.feature || m.threshold != n.threshold || m.next != n.next) return false;
    }
  }
  return true;
}

TEST(RandomForest, VotesAsOpenCvDoes) {
  const LabelledFeatures data = clusters(4, 25, 6, 0.8, 1), others = clusters(4, 25, 6, 1.2, 2);
  const cv::Ptr<cv::ml::RTrees> trees = cv::ml::RTrees::create();
  trees->setMinSampleCount(2);
  trees->setTermCriteria(cv::TermCriteria(cv::TermCriteria::MAX_ITER, 40, 0));
  cv::Mat labels(100, 1, CV_32S);
  std::copy(data.labels.begin(), data.labels.end(), labels.begin<int>());
  trees->train(cv::ml::TrainData::create(row_matrix(data.rows), cv::ml::ROW_SAMPLE, labels));
  std::vector<int> columns(6);
  std::iota(columns.begin(), columns.end(), 0);
  const RandomForest forest = converted(*trees, columns, 4);
  ASSERT_EQ(forest.trees.size(), 40u);
  for (const LabelledFeatures* set : {&data, &others}) {
    cv::Mat counts;  // a row of labels, then a row of votes for each sample
    trees->getVotes(row_matrix(set->rows), counts, 0);
    for (int i = 0; i < 100; ++i) {
      const std::vector<double> votes = forest.votes(set->rows[static_cast<std::size_t>(i)]);
      for (int c = 0; c < 4; ++c) {
        EXPECT_EQ(std::lround(40 * votes[static_cast<std::size_t>(c)]), counts.at<int>(i + 1, c));
      }
    }
  }
}

TEST(RandomForest, TellsClustersApart) {
  const LabelledFeatures data = clusters(3, 20, 5, 0.1, 1);
  const RandomForest forest = train_forest(data.rows, data.labels, 3, {50, 25, 1});
  const LabelledFeatures fresh = clusters(3, 20, 5, 0.1, 9);
  for (std::size_t i = 0; i < fresh.rows.size(); ++i) {
    const std::vector<double> votes = forest.votes(fresh.rows[i]);
    EXPECT_EQ(winner(votes), fresh.labels[i]);
    EXPECT_NEAR(std::accumulate(votes.begin(), votes.end(), 0.0), 1, 1e-12);
  }
}

TEST(RandomForest, LabelsMayBeMissing) {
  LabelledFeatures data = clusters(3, 20, 5, 0.1, 1);
  for (int& label : data.labels) label = label == 0 ? 1 : label == 1 ? 3 : 4;  // no label is 0 or 2
  const RandomForest forest = train_forest(data.rows, data.labels, 6, {20, 25, 1});
  for (std::size_t i = 0; i < data.rows.size(); ++i)
    EXPECT_EQ(winner(forest.votes(data.rows[i])), data.labels[i]);
}

TEST(RandomForest, SameTreesForAnyThreadCountAndNoOtherSeed) {
  const LabelledFeatures data = clusters(3, 30, 40, 1, 1);
  const RandomForest first = train_forest(data.rows, data.labels, 3, {30, 25, 5});
  std::vector<RandomForest> more(8);
  parallel_for(0, 8, [&](std::int64_t i) {
    more[static_cast<std::size_t>(i)] = train_forest(data.rows, data.labels, 3, {30, 25, 5});
  });
  for (const RandomForest& forest : more) EXPECT_TRUE(same(forest, first));
  EXPECT_FALSE(same(train_forest(data.rows, data.labels, 3, {30, 25, 6}), first));
  train_forest(data.rows, data.labels, 3, {5, 25, 0x61c8864680b583ebu});  // a seed whose hash would be 0
}

TEST(RandomForest, DepthIsABound) {
  const LabelledFeatures data = clusters(3, 30, 5, 2, 1);
  for (const DecisionTree& tree : train_forest(data.rows, data.labels, 3, {10, 1, 1}).trees) {
    EXPECT_LE(tree.size(), 3u);
  }
}

// Only one feature tells the classes apart. A draw of sqrt(#features) of all features would nearly always
// miss it.
TEST(RandomForest, FeaturesThatNeverVaryAreNotDrawn) {
  LabelledFeatures data = clusters(2, 20, 1, 0.05, 1);
  for (auto& row : data.rows) row.insert(row.begin(), 5000, 3.0f);
  const RandomForest forest = train_forest(data.rows, data.labels, 2, {20, 25, 1});
  for (std::size_t i = 0; i < data.rows.size(); ++i)
    EXPECT_EQ(winner(forest.votes(data.rows[i])), data.labels[i]);
}

TEST(RandomForest, RefusesWhatCannotBeLearned) {
  const LabelledFeatures data = clusters(2, 5, 3, 0.1, 1);
  EXPECT_THROW(train_forest(data.rows, data.labels, 1, {}), InputError);
  EXPECT_THROW(train_forest({}, {}, 2, {}), InputError);
  EXPECT_THROW(train_forest(data.rows, data.labels, 2, {0, 25, 1}), InputError);
  EXPECT_THROW(train_forest(data.rows, data.labels, 2, {10, 0, 1}), InputError);
  const FeatureRows equal(10, std::vector<float>(3, 1.0f));
  EXPECT_THROW(train_forest(equal, data.labels, 2, {}), InputError);
}

}  // namespace
}  // namespace astrolith
