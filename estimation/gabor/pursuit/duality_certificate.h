// Certifies how close a solution of basis pursuit is to the optimum.
#pragma once

#include <span>
#include <vector>

#include "estimation/gabor/pursuit/basis_pursuit.h"

namespace astrolith {

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
  double relative_gap_of(double primal) const;

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
