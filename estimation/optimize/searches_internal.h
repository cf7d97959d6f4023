// The optimisers, and the record that each keeps while it runs.
#pragma once

#include <fmt/format.h>

#include <cmath>

#include "estimation/optimize/optimizer.h"

namespace astrolith {

// They minimise as optimizer.h says: by a particle swarm with constriction, and by an algorithm of NLopt.
OptimizeResult particle_swarm(const BatchObjective& objective, const Bounds& bounds,
                              const OptimizeOptions& options, const Progress& progress);
OptimizeResult nlopt_search(const BatchObjective& objective, const Bounds& bounds,
                            const OptimizeOptions& options, const Progress& progress);

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

  // Is called after each generation. Returns false when the run is to end.
  bool generation_done() {
    result_.history.push_back(result_.value);
    const double done =
        static_cast<double>(result_.evaluations) / static_cast<double>(options_.max_evaluations);
    result_.stopped = !report(progress_, std::fmin(done, 1.0), fmt::format("best {:.6g}", result_.value));
    return !result_.stopped && result_.evaluations < options_.max_evaluations;
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
