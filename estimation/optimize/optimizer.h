// Minimises a function of a few dozen numbers inside a box, without derivatives. One interface serves
// particle swarm and four algorithms of NLopt.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "numerics/progress.h"

namespace astrolith {

enum class OptimizerAlgorithm {
  pso,    // global-best particle swarm with constriction (Clerc and Kennedy, IEEE TEC 2002)
  crs2,   // controlled random search with local mutation (Kaelo and Ali 2006; NLopt GN_CRS2_LM)
  isres,  // stochastic-ranking evolution strategy (Runarsson and Yao 2005; NLopt GN_ISRES)
  esch,   // evolutionary algorithm (da Silva Santos 2010; NLopt GN_ESCH)
  sbplx   // subspace simplex, local, from the start (Rowan 1990; NLopt LN_SBPLX)
};

// The algorithm of a name such as "pso". Throws InputError, which lists the names, for an unknown name.
OptimizerAlgorithm optimizer_from_name(const std::string& name);

// lower[i] <= x[i] <= upper[i], all finite; equal bounds fix a variable.
struct Bounds {
  std::vector<double> lower, upper;
};

struct OptimizeOptions {
  OptimizerAlgorithm algorithm = OptimizerAlgorithm::pso;
  // The number of particles of pso, or the population of crs2, isres and esch. crs2 takes at least one more
  // than there are variables. 0 stands for 20 for pso, and for NLopt's choice for the others.
  int population = 0;
  // The largest number of calls of the objective. pso rounds it up to whole generations.
  std::int64_t max_evaluations = 2000;
  std::uint64_t seed = 1;
  // The start: one particle of pso, the first point of the others, clipped to the box. If it is empty, pso
  // starts at random and the others at the centre of the box.
  std::vector<double> start;
};

struct OptimizeResult {
  std::vector<double> x;                                   // inside the bounds
  double value = std::numeric_limits<double>::infinity();  // at x; infinite if no value was finite
  std::int64_t evaluations = 0;
  std::vector<double> history;  // best value after each generation (each population of calls for NLopt)
  bool stopped = false;         // progress asked for the end
};

// Values that are not finite count as +infinity. pso calls the objective from many threads at once.
using Objective = std::function<double(std::span<const double> x)>;

// The values at many points at once, for objectives that compute them faster together. pso asks for all
// points of a generation, the others for one point at a time.
using BatchObjective = std::function<std::vector<double>(std::span<const std::vector<double>> points)>;

// Minimises the objective. The result is a function of objective, bounds and options alone: the thread count
// and other runs in the process do not change it. `progress` is called after every generation, possibly from
// another thread than the caller's; when it returns false, the best point so far is returned. Exceptions of
// the objective end the run and are rethrown. Throws InputError for wrong bounds or options.
OptimizeResult minimize(const Objective& objective, const Bounds& bounds, const OptimizeOptions& options = {},
                        const Progress& progress = {});
OptimizeResult minimize(const BatchObjective& objective, const Bounds& bounds,
                        const OptimizeOptions& options = {}, const Progress& progress = {});

}  // namespace astrolith
