// The record that every optimiser keeps while it runs.
#pragma once

#include <fmt/format.h>

#include <cmath>

#include "estimation/optimize/optimizer.h"

namespace astrolith {

class BestSoFar {
 public:
  BestSoFar(const OptimizeOptions& options, const Progress& progress)
      : options_(options), progress_(progress) {}

  // Counts one evaluation. The first of several equal values stays the best.
  void record(std::span<const double> x, double value) {
    ++result_.evaluations;
    if (!result_.x.empty() && !(value < result_.value)) return;
    result_.x.assign(x.begin(), x.end());
    result_.value = value;
  }

  // Is called after each generation. Returns false and sets the termination when the run is to end.
  bool generation_done() {
    result_.history.push_back(result_.value);
    const double done =
        static_cast<double>(result_.evaluations) / static_cast<double>(options_.max_evaluations);
    if (result_.value <= options_.target) return end(OptimizeTermination::target);
    if (!report(progress_, std::fmin(done, 1.0), fmt::format("best {:.6g}", result_.value))) {
      return end(OptimizeTermination::stopped);
    }
    return result_.evaluations < options_.max_evaluations || end(OptimizeTermination::evaluations);
  }

  bool end(OptimizeTermination why) {
    result_.termination = why;
    return false;
  }
  const OptimizeResult& result() const { return result_; }

 private:
  const OptimizeOptions& options_;
  const Progress& progress_;
  OptimizeResult result_;
};

inline double finite_or_infinity(double value) {
  return std::isfinite(value) ? value : std::numeric_limits<double>::infinity();
}

}  // namespace astrolith
