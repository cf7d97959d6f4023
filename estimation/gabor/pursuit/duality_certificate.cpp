#include "estimation/gabor/pursuit/duality_certificate.h"

#include <algorithm>
#include <cmath>

#include "numerics/errors.h"
#include "numerics/sample_statistics.h"

namespace astrolith {

double largest_penalty(const GaborDictionary& dictionary, std::span<const double> target) {
  std::vector<double> correlations(dictionary.size());
  dictionary.analyze(target, correlations);
  double largest = 0.0;
  for (const double c : correlations) largest = std::max(largest, c);
  return largest;
}

DualityCertificate::DualityCertificate(const BasisPursuitProblem& problem)
    : problem_(problem),
      column_sums_(problem.dictionary.size()),
      squared_target_(sum_of_products(problem.target, problem.target)) {
  problem.dictionary.analyze(std::vector<double>(problem.dictionary.rows(), 1.0), column_sums_);
}

double DualityCertificate::scaled_bound(std::span<const double> r,
                                        std::span<const double> correlations) const {
  const double squared_r = sum_of_products(r, r);
  const double target_r = sum_of_products(problem_.target, r);
  if (squared_r == 0.0) return 0.0;
  double largest = 0.0;
  for (const double c : correlations) largest = std::max(largest, c);
  double t = std::max(0.0, target_r / squared_r);
  if (largest > 0.0) t = std::min(t, problem_.penalty / largest);
  return t * target_r - 0.5 * t * t * squared_r;
}

double DualityCertificate::translated_bound(std::span<const double> r,
                                            std::span<const double> correlations) const {
  double shift = 0.0;
  for (std::size_t j = 0; j < correlations.size(); ++j) {
    const double excess = correlations[j] - problem_.penalty;
    if (excess <= 0.0) continue;
    if (column_sums_[j] <= 0.0) return 0.0;  // no shift repairs this column
    shift = std::max(shift, excess / column_sums_[j]);
  }
  double bound = 0.0;
  for (std::size_t i = 0; i < r.size(); ++i) {
    const double theta = r[i] - shift;
    bound += theta * (problem_.target[i] - 0.5 * theta);
  }
  return bound;
}

double DualityCertificate::check(std::span<const double> r, std::span<const double> correlations,
                                 double sum_x) {
  primal_ = 0.5 * sum_of_products(r, r) + problem_.penalty * sum_x;
  best_dual_ = std::max({best_dual_, scaled_bound(r, correlations), translated_bound(r, correlations)});
  const double rounding = 1e-10 * (primal_ + 0.5 * squared_target_);
  if (!(primal_ - best_dual_ >= -rounding)) {
    throw WorkError(
        "basis pursuit: the duality gap is negative; the dictionary's transposed product is wrong");
  }
  return relative_gap_of(primal_);
}

double DualityCertificate::relative_gap_of(double primal) const {
  return primal <= 0.0 ? 0.0 : std::max(0.0, (primal - best_dual_) / primal);
}

}  // namespace astrolith
