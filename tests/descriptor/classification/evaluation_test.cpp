#include <algorithm>
#include <cmath>

#include "descriptor/classification/evaluation.h"
#include "descriptor/classification/retrieval.h"
#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "tests/descriptor/classification/clusters.h"
#include "tests/support/meshes.h"

namespace astrolith {
namespace {

TEST(PrecisionRecall, OfAKnownRanking) {
  // The first, third and fourth entries are relevant: precision is 1, 2/3, 3/4 at recall 1/3, 2/3, 1.
  const std::vector<double> scores{0.9, 0.8, 0.7, 0.6, 0.5};
  const PrecisionRecall r = precision_recall(scores, {true, false, true, true, false});
  EXPECT_NEAR(r.average_precision, (1 + 2.0 / 3 + 3.0 / 4) / 3, 1e-12);
  EXPECT_NEAR(r.curve[0], 1, 1e-12);
  EXPECT_NEAR(r.curve[6], 1, 1e-12);     // recall 0.30
  EXPECT_NEAR(r.curve[7], 0.75, 1e-12);  // recall 0.35: the later 3/4 is better than 2/3
  EXPECT_NEAR(r.curve[20], 0.75, 1e-12);
}

TEST(PrecisionRecall, EqualScoresComeTogether) {
  const std::vector<double> equal(4, 0.5);
  EXPECT_NEAR(precision_recall(equal, {true, false, false, false}).average_precision, 0.25, 1e-12);
  EXPECT_NEAR(precision_recall(equal, {false, false, false, true}).average_precision, 0.25, 1e-12);
}

TEST(PrecisionRecall, BestWorstAndNone) {
  const std::vector<double> scores{3, 2, 1};
  EXPECT_EQ(precision_recall(scores, {true, true, false}).average_precision, 1);
  EXPECT_NEAR(precision_recall(scores, {false, false, true}).average_precision, 1.0 / 3, 1e-12);
  EXPECT_EQ(precision_recall(scores, {false, false, false}).average_precision, 0);
  EXPECT_EQ(precision_recall({}, {}).average_precision, 0);
}

TEST(Evaluation, CountsWhatIsCalledWhat) {
  const VoteRows votes{{0.8, 0.2, 0}, {0.4, 0.6, 0}, {0.1, 0.9, 0}, {0.2, 0.3, 0.5}, {0.5, 0.5, 0}};
  const std::vector<int> labels{0, 0, 1, 2, 1};
  const Evaluation e = evaluate(votes, labels, 3);
  EXPECT_EQ(e.shapes, 5);
  EXPECT_NEAR(e.accuracy, 0.6, 1e-12);
  EXPECT_EQ(e.confusion, (std::vector<std::vector<int>>{{1, 1, 0}, {1, 1, 0}, {0, 0, 1}}));
  EXPECT_NEAR(e.classes[0].precision, 0.5, 1e-12);
  EXPECT_NEAR(e.classes[0].recall, 0.5, 1e-12);
  EXPECT_EQ(e.classes[2].precision, 1);
  EXPECT_EQ(e.classes[2].ranking.average_precision, 1);
  EXPECT_NEAR(e.mean_average_precision,
              (e.classes[0].ranking.average_precision + e.classes[1].ranking.average_precision + 1) / 3,
              1e-12);
}

TEST(Evaluation, AClassThatNobodyCalls) {
  const Evaluation e = evaluate({{1, 0}, {1, 0}}, std::vector<int>{0, 1}, 2);
  EXPECT_EQ(e.classes[1].precision, 0);
  EXPECT_EQ(e.classes[1].recall, 0);
  EXPECT_EQ(e.accuracy, 0.5);
}

using testing::clusters;

TEST(StratifiedFolds, HoldEveryClassInEqualShares) {
  std::vector<int> labels(14, 0);
  labels.insert(labels.end(), 13, 1);
  labels.insert(labels.end(), 5, 2);
  const std::vector<int> folds = stratified_folds(labels, 3, 5, 1);
  for (int c = 0; c < 3; ++c) {
    const auto class_count = std::count(labels.begin(), labels.end(), c);
    for (int fold = 0; fold < 5; ++fold) {
      std::int64_t both = 0;
      for (std::size_t i = 0; i < labels.size(); ++i) both += labels[i] == c && folds[i] == fold ? 1 : 0;
      EXPECT_GE(both, class_count / 5);
      EXPECT_LE(both, (class_count + 4) / 5);
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
