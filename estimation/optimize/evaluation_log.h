// What an objective's values were, by the points they were asked for. The optimisers are functions of
// objective, bounds and options alone, so a run that is begun again with the log of an earlier one takes the
// same way at once to where that one stopped, whatever the algorithm: that is all a checkpoint needs.
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
  // May be called from many threads at once.
  std::optional<double> find(std::span<const double> x) const;
  void add(std::span<const double> x, double value);
  std::size_t size() const;

  // Keys are hashes of all bits of a point; ascending.
  std::map<std::uint64_t, double> entries() const;
  void restore(std::map<std::uint64_t, double> entries);

 private:
  mutable std::mutex mutex_;
  std::map<std::uint64_t, double> values_;
};

// The objective, asked only where the log has no value, and logged. Both must outlive the result.
BatchObjective logged(const BatchObjective& objective, EvaluationLog& log);

}  // namespace astrolith
