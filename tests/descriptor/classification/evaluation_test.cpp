#include "descriptor/classification/evaluation.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace astrolith
