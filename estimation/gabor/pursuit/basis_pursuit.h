// Non-negative basis pursuit denoising with a certified duality gap:
//
//   minimise  P(x) = 1/2 |A x - s|^2 + penalty * sum x,   x >= 0        (Galerne et al. 2012, eq. 14)
//
// over the Gabor dictionary A.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "estimation/gabor/pursuit/gabor_dictionary.h"
#include "numerics/progress.h"

namespace astrolith {

struct BasisPursuitProblem {
  const GaborDictionary& dictionary;
  std::vector<double> target;  // s: dictionary.rows() values
  double penalty = 0.0;        // > 0
};

struct BasisPursuitOptions {
  double relative_gap = 1e-3;  // stop when (P - best dual) / P is at most this, > 0
  int max_iterations = 20000;
  // Stop at so many atoms. Photos take 30 to 300; sharp edges of a spectrum would take thousands.
  std::size_t most_atoms = 600;
};

// The values at one check of the certificate.
struct GapSample {
  int iteration = 0;
  double primal = 0.0;        // P(x)
  double relative_gap = 0.0;  // >= 0
};

struct BasisPursuitResult {
  std::vector<double> x;  // dictionary.size() values, >= 0
  double primal = 0.0;
  double relative_gap = 0.0;  // certified: (P(x) - minimum of P) / P(x) is at most this
  int iterations = 0;
  bool reached = false;  // relative_gap is at most the one asked for
  std::vector<GapSample> history;
};

// The smallest penalty whose solution is x = 0: max_j (a_j's)+.
double largest_penalty(const GaborDictionary& dictionary, std::span<const double> target);

// The working-set method. It solves the problem exactly on a few atoms, adds the atoms that violate
// optimality most, drops the atoms at zero, and repeats. `start`, if not empty, is a first guess of x.
BasisPursuitResult solve_working_set(const BasisPursuitProblem& problem, const BasisPursuitOptions& options,
                                     const Progress& progress = {}, std::span<const double> start = {});

}  // namespace astrolith
