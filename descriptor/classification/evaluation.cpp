#include "descriptor/classification/evaluation.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <string>
#include <utility>

#include "descriptor/classification/random_forest.h"
#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

void check(const LabelledFeatures& data, int folds) {
  if (folds < 2 || static_cast<std::size_t>(folds) > data.rows.size()) {
    throw InputError("cross-validation: " + std::to_string(folds) + " folds of " +
                     std::to_string(data.rows.size()) + " shapes; give at least 2, and a shape for each");
  }
  for (std::size_t c = 0; c < data.classes.size(); ++c) {
    if (std::count(data.labels.begin(), data.labels.end(), static_cast<int>(c)) < 2) {
      throw InputError("cross-validation: class " + data.classes[c] +
                       " has fewer than two shapes; give it more, or no folds");
    }
  }
}

LabelledFeatures without_fold(const LabelledFeatures& data, const std::vector<int>& sample_fold, int fold) {
  LabelledFeatures rest{data.classes, {}, {}};
  for (std::size_t i = 0; i < data.rows.size(); ++i) {
    if (sample_fold[i] == fold) continue;
    rest.rows.push_back(data.rows[i]);
    rest.labels.push_back(data.labels[i]);
  }
  return rest;
}

double ratio(int part, int whole) { return whole > 0 ? static_cast<double>(part) / whole : 0; }

ClassScore class_score(std::size_t c, const VoteRows& votes, std::span<const int> labels,
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

std::vector<int> stratified_folds(std::span<const int> labels, int classes, int folds, std::uint64_t seed) {
  std::vector<int> sample_fold(labels.size(), 0);
  int next = 0;  // counts on from class to class, so that no fold gets all remainders
  for (int c = 0; c < classes; ++c) {
    std::vector<std::size_t> members;
    for (std::size_t i = 0; i < labels.size(); ++i) {
      if (labels[i] == c) members.push_back(i);
    }
    CounterRandom random(seed, static_cast<std::uint64_t>(c));
    for (std::size_t i = members.size(); i > 1; --i) std::swap(members[i - 1], members[random.below(i)]);
    for (const std::size_t i : members) sample_fold[i] = next++ % folds;
  }
  return sample_fold;
}

VoteRows cross_validate(const LabelledFeatures& data, const TrainingOptions& options, int folds,
                        std::uint64_t seed, const Progress& progress) {
  check(data, folds);
  const std::vector<int> sample_fold =
      stratified_folds(data.labels, static_cast<int>(data.classes.size()), folds, seed);
  VoteRows votes(data.rows.size());
  std::mutex reporting;
  int done = 0;
  std::atomic<bool> stopped{false};
  parallel_for(0, folds, [&](std::int64_t fold) {
    if (stopped) return;
    const ShapeClassifier classifier =
        train_classifier(without_fold(data, sample_fold, static_cast<int>(fold)), {}, options);
    for (std::size_t i = 0; i < data.rows.size(); ++i) {
      if (sample_fold[i] == fold) votes[i] = classifier.votes(data.rows[i]);
    }
    const std::lock_guard lock(reporting);
    ++done;
    if (!report(progress, static_cast<double>(done) / folds, "fold " + std::to_string(done))) stopped = true;
  });
  if (stopped && done < folds) throw WorkError("cross-validation: stopped; run it again");
  return votes;
}

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
    result.classes.push_back(class_score(c, votes, labels, result.confusion));
    result.mean_average_precision += result.classes.back().ranking.average_precision / classes;
  }
  return result;
}

}  // namespace astrolith
