#include "descriptor/classification/evaluation.h"

#include <algorithm>

#include "descriptor/classification/random_forest.h"

namespace astrolith {
namespace {

double ratio(int part, int whole) { return whole > 0 ? static_cast<double>(part) / whole : 0; }

ClassScore score_of(std::size_t c, const VoteRows& votes, std::span<const int> labels,
                    const std::vector<std::vector<int>>& confusion) {
  ClassScore score;
  int called = 0;
  for (std::size_t other = 0; other < confusion.size(); ++other) {
    score.shapes += confusion[c][other];
    called += confusion[other][c];
  }
  score.precision = ratio(confusion[c][c], called);
  score.recall = ratio(confusion[c][c], score.shapes);
  std::vector<double> scores;
  std::vector<bool> relevant;
  for (std::size_t i = 0; i < votes.size(); ++i) {
    scores.push_back(votes[i][c]);
    relevant.push_back(labels[i] == static_cast<int>(c));
  }
  score.ranking = precision_recall(scores, relevant);
  return score;
}

}  // namespace

Evaluation evaluate(const VoteRows& votes, std::span<const int> labels, int classes) {
  const auto size = static_cast<std::size_t>(classes);
  Evaluation result;
  result.shapes = static_cast<int>(votes.size());
  result.confusion.assign(size, std::vector<int>(size, 0));
  int right = 0;
  for (std::size_t i = 0; i < votes.size(); ++i) {
    const int called = winner(votes[i]);
    ++result.confusion[static_cast<std::size_t>(labels[i])][static_cast<std::size_t>(called)];
    right += called == labels[i] ? 1 : 0;
  }
  result.accuracy = ratio(right, result.shapes);
  for (std::size_t c = 0; c < size; ++c) {
    result.classes.push_back(score_of(c, votes, labels, result.confusion));
    result.mean_average_precision += result.classes.back().ranking.average_precision / classes;
  }
  return result;
}

}  // namespace astrolith
