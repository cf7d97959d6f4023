#include "estimation/optimize/optimizer.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "estimation/optimize/searches_internal.h"
#include "numerics/errors.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

constexpr std::array<const char*, 5> kNames = {"pso", "crs2", "isres", "esch", "sbplx"};

void check(const Bounds& bounds, const OptimizeOptions& options) {
  const std::size_t n = bounds.lower.size();
  if (n == 0 || bounds.upper.size() != n) {
    throw InputError("optimizer: needs a lower and an upper bound for each variable");
  }
  for (std::size_t d = 0; d < n; ++d) {
    if (!std::isfinite(bounds.upper[d] - bounds.lower[d]) || bounds.lower[d] > bounds.upper[d]) {
      throw InputError("optimizer: the bounds of variable " + std::to_string(d) +
                       " are not a finite range; give lower <= upper");
    }
  }
  if (options.max_evaluations < 1) throw InputError("optimizer: needs at least one evaluation");
  if (options.population < 0 || options.population > 1'000'000) {
    throw InputError("optimizer: the population must lie between 0 (automatic) and 1000000");
  }
  if (!options.start.empty() && options.start.size() != n) {
    throw InputError("optimizer: the start has " + std::to_string(options.start.size()) + " values for " +
                     std::to_string(n) + " variables");
  }
}

// Clips the start to the box. NaN becomes the lower bound.
OptimizeOptions inside(OptimizeOptions options, const Bounds& bounds) {
  for (std::size_t d = 0; d < options.start.size(); ++d) {
    options.start[d] = std::fmin(std::fmax(options.start[d], bounds.lower[d]), bounds.upper[d]);
  }
  return options;
}

}  // namespace

OptimizerAlgorithm optimizer_from_name(const std::string& name) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) {
    throw InputError("optimizer '" + name + "' is unknown; choose pso, crs2, isres, esch or sbplx");
  }
  return static_cast<OptimizerAlgorithm>(found - kNames.begin());
}

OptimizeResult minimize(const BatchObjective& objective, const Bounds& bounds, const OptimizeOptions& given,
                        const Progress& progress) {
  check(bounds, given);
  OptimizeOptions options = inside(given, bounds);
  if (options.algorithm != OptimizerAlgorithm::pso) return nlopt_search(objective, bounds, options, progress);
  if (options.population == 0) options.population = 20;
  return particle_swarm(objective, bounds, options, progress);
}

OptimizeResult minimize(const Objective& objective, const Bounds& bounds, const OptimizeOptions& options,
                        const Progress& progress) {
  const BatchObjective in_parallel = [&](std::span<const std::vector<double>> points) {
    std::vector<double> values(points.size());
    parallel_for(0, static_cast<std::int64_t>(points.size()), [&](std::int64_t i) {
      values[static_cast<std::size_t>(i)] = objective(points[static_cast<std::size_t>(i)]);
    });
    return values;
  };
  return minimize(in_parallel, bounds, options, progress);
}

}  // namespace astrolith
