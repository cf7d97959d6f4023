#include "descriptor/classification/retrieval.h"

#include <algorithm>
#include <cstdint>
#include <numeric>

#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

struct Step {
  double recall, precision;
};

// One step for each group of equal scores, the highest first.
std::vector<Step> recall_steps(std::span<const double> scores, const std::vector<bool>& relevant) {
  std::vector<std::size_t> order(scores.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return scores[a] > scores[b]; });
  const auto all = static_cast<double>(std::count(relevant.begin(), relevant.end(), true));
  std::vector<Step> steps;
  double found = 0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    found += relevant[order[k]] ? 1 : 0;
    const bool group_ends = k + 1 == order.size() || scores[order[k + 1]] != scores[order[k]];
    if (group_ends && all > 0) steps.push_back({found / all, found / static_cast<double>(k + 1)});
  }
  return steps;
}

struct Answer {
  bool asked = false;  // false: no other shape is of its class
  bool nearest_right = false;
  PrecisionRecall ranking;
};

Answer ask(std::size_t query, const FeatureRows& rows, std::span<const int> labels,
           const FeatureDistance& distance) {
  std::vector<double> scores;
  std::vector<bool> relevant;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (i == query) continue;
    scores.push_back(-distance(rows[query], rows[i]));
    relevant.push_back(labels[i] == labels[query]);
  }
  Answer answer;
  answer.asked = std::find(relevant.begin(), relevant.end(), true) != relevant.end();
  if (!answer.asked) return answer;
  const auto nearest = std::max_element(scores.begin(), scores.end()) - scores.begin();
  answer.nearest_right = relevant[static_cast<std::size_t>(nearest)];
  answer.ranking = precision_recall(scores, relevant);
  return answer;
}

}  // namespace

PrecisionRecall precision_recall(std::span<const double> scores, const std::vector<bool>& relevant) {
  const std::vector<Step> steps = recall_steps(scores, relevant);
  PrecisionRecall result;
  double before = 0;
  for (const Step& step : steps) {
    result.average_precision += (step.recall - before) * step.precision;
    before = step.recall;
  }
  for (int level = 0; level < kRecallLevels; ++level) {
    // Recall is a ratio of small integers. The tolerance ensures that a level which should be reached is
    // reached.
    const double least = static_cast<double>(level) / (kRecallLevels - 1) - 1e-12;
    double& best = result.curve[static_cast<std::size_t>(level)];
    for (const Step& step : steps) {
      if (step.recall >= least) best = std::max(best, step.precision);
    }
  }
  return result;
}

Retrieval retrieve(const FeatureRows& rows, std::span<const int> labels, const FeatureDistance& distance) {
  std::vector<Answer> answers(rows.size());
  parallel_for(0, static_cast<std::int64_t>(rows.size()), [&](std::int64_t i) {
    answers[static_cast<std::size_t>(i)] = ask(static_cast<std::size_t>(i), rows, labels, distance);
  });
  Retrieval result;
  double all = 0;
  for (const Answer& answer : answers) {
    if (!answer.asked) continue;
    all += 1;
    result.mean_average_precision += answer.ranking.average_precision;
    result.nearest_accuracy += answer.nearest_right ? 1 : 0;
    for (std::size_t k = 0; k < kRecallLevels; ++k) result.curve[k] += answer.ranking.curve[k];
  }
  if (all == 0) return result;
  result.mean_average_precision /= all;
  result.nearest_accuracy /= all;
  for (double& precision : result.curve) precision /= all;
  return result;
}

}  // namespace astrolith
