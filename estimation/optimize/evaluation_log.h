// A log of an objective's values by their points, which serves as a checkpoint. The optimisers are functions
// of objective, bounds and options alone. A run that starts with the log of an earlier run therefore repeats
// its steps without evaluations, and goes on where the earlier run stopped.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <span>

#include "estimation/optimize/optimizer.h"

namespace astrolith {

class EvaluationLog {
 public:
  // Many threads may call these functions at once.
  std::optional<double> find(std::span<const double> x) const;
  void add(std::span<const double> x, double value);
  std::size_t size() const;

  // The values by key, ascending. A key is a hash of all bits of a point.
  std::map<std::uint64_t, double> entries() const;
  void restore(std::map<std::uint64_t, double> entries);

 private:
  mutable std::mutex mutex_;
  std::map<std::uint64_t, double> values_;
};

// An objective that evaluates `objective` only at points without a value in the log, and adds the values to
// the log. `objective` and `log` must outlive the result.
BatchObjective logged(const BatchObjective& objective, EvaluationLog& log);

}  // namespace astrolith
