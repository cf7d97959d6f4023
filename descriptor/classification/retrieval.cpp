#include "descriptor/classification/retrieval.h"

#include <algorithm>
#include <cstdint>

#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

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
