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

// The dual of min 1/2 |A x - s|^2 + penalty 1'x, x >= 0 is
//   maximise 1/2 |s|^2 - 1/2 |s - theta|^2   subject to  A'theta <= penalty (one-sided, because x >= 0).
// Any feasible theta bounds the minimum from below. Two of them are computed from a residual r = s - A x:
//   scaled      theta = t r,        t = clip(s'r / |r|^2, 0, penalty / max_j (a_j'r)+)
//   translated  theta = r - e 1,    e = max_j ((a_j'r - penalty) / a_j'1)+       (A has no negative entries)
// The best bound of all checks is kept. The clip at 0 is needed, since a negative t can leave the feasible
// set.
class DualityCertificate {
 public:
  explicit DualityCertificate(const BasisPursuitProblem& problem);

  // Returns the relative gap (P(x) - best dual) / P(x) >= 0 for r = s - A x, correlations = A'r, sum_x = 1'x.
  // Throws WorkError where the gap is negative by more than rounding, as a wrong A' makes it.
  double check(std::span<const double> r, std::span<const double> correlations, double sum_x);

  // The relative gap of an earlier P(x), with the best bound known now.
  double relative_gap_to(double primal) const;

  double primal() const { return primal_; }        // P(x) of the last check
  double best_dual() const { return best_dual_; }  // best of all checks; at least 0, the value at theta = 0

 private:
  double scaled_bound(std::span<const double> r, std::span<const double> correlations) const;
  double translated_bound(std::span<const double> r, std::span<const double> correlations) const;

  const BasisPursuitProblem& problem_;
  std::vector<double> column_sums_;  // A'1
  double squared_target_ = 0.0;
  double primal_ = 0.0;
  double best_dual_ = 0.0;
};

}  // namespace astrolith
