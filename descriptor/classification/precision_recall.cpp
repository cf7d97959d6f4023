#include "descriptor/classification/precision_recall.h"

#include <algorithm>
#include <numeric>

namespace astrolith {
namespace {

struct Step {
  double recall, precision;
};

// One step for each group of equal scores, the highest first.
std::vector<Step> steps_of(std::span<const double> scores, const std::vector<bool>& relevant) {
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

}  // namespace

PrecisionRecall precision_recall(std::span<const double> scores, const std::vector<bool>& relevant) {
  const std::vector<Step> steps = steps_of(scores, relevant);
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

}  // namespace astrolith
