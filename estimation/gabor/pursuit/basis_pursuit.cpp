#include "estimation/gabor/pursuit/basis_pursuit.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "estimation/gabor/pursuit/lobe_overlap.h"
#include "estimation/gabor/pursuit/nonnegative_quadratic.h"
#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "numerics/sample_statistics.h"

namespace astrolith {
namespace {

// The problem restricted to a few atoms: their inner products and their solution.
class RestrictedProblem {
 public:
  RestrictedProblem(const BasisPursuitProblem& problem, std::span<const double> target_correlations)
      : problem_(problem),
        target_correlations_(target_correlations),
        contained_(problem.dictionary.size(), false) {
    for (const double w : problem.dictionary.weight()) metric_.push_back(w * w);
  }

  bool contains(std::size_t j) const { return contained_[j]; }
  const std::vector<std::size_t>& atoms() const { return atoms_; }

  // The solution as coefficients of the whole dictionary.
  std::vector<double> coefficients() const {
    std::vector<double> x(contained_.size(), 0.0);
    for (std::size_t i = 0; i < atoms_.size(); ++i) x[atoms_[i]] = x_(static_cast<Eigen::Index>(i));
    return x;
  }

  double sum_x() const {
    double sum = 0.0;
    for (const double x : x_) sum += x;
    return sum;
  }

  // Adds atoms, with their values in `start` as a first guess, or 0 if `start` is empty.
  void add(const std::vector<std::size_t>& atoms, std::span<const double> start) {
    const auto old = static_cast<Eigen::Index>(atoms_.size());
    for (const std::size_t j : atoms) {
      atoms_.push_back(j);
      contained_[j] = true;
      profiles_.push_back(profile(j));
    }
    const auto n = static_cast<Eigen::Index>(atoms_.size());
    x_.conservativeResize(n);
    for (Eigen::Index i = old; i < n; ++i)
      x_(i) = start.empty() ? 0.0 : start[atoms_[static_cast<std::size_t>(i)]];
    extend_gram(old, n);
  }

  // Returns whether the minimum was reached within `max_solves` factorisations, and before progress asked to
  // stop.
  bool solve(int max_solves, const Progress& progress) {
    Eigen::VectorXd q(x_.size());
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      q(i) = target_correlations_[atoms_[static_cast<std::size_t>(i)]] - problem_.penalty;
    }
    return q.size() == 0 || minimize_nonnegative_quadratic(gram_, q, x_, max_solves, progress);
  }

  void drop_zeros() {
    std::vector<Eigen::Index> kept;
    for (Eigen::Index i = 0; i < x_.size(); ++i) {
      const bool keep = x_(i) > 0.0;
      if (keep) kept.push_back(i);
      contained_[atoms_[static_cast<std::size_t>(i)]] = keep;
    }
    for (std::size_t k = 0; k < kept.size(); ++k) {
      const auto i = static_cast<std::size_t>(kept[k]);
      atoms_[k] = atoms_[i];
      if (i != k) profiles_[k] = std::move(profiles_[i]);
    }
    atoms_.resize(kept.size());
    profiles_.resize(kept.size());
    gram_ = Eigen::MatrixXd(gram_(kept, kept));
    x_ = Eigen::VectorXd(x_(kept));
  }

 private:
  void extend_gram(Eigen::Index old, Eigen::Index n) {
    gram_.conservativeResize(n, n);
    parallel_for(old, n, [&](std::int64_t row) {
      for (Eigen::Index column = 0; column <= row; ++column) {
        gram_(row, column) = gram_(column, row) = row == column ? 1.0 : overlap(row, column);
      }
    });
  }

  double overlap(Eigen::Index i, Eigen::Index j) const {
    return lobe_overlap(metric_, profiles_[static_cast<std::size_t>(i)],
                        profiles_[static_cast<std::size_t>(j)]);
  }

  LobeProfile profile(std::size_t j) const {
    const GaborDictionary& d = problem_.dictionary;
    const GaborAtom& atom = d.atom(j);
    const double deviation = lobe_deviation(atom.bandwidth);
    return make_lobe_profile(d.width(), d.height(), atom.kx, atom.ky, deviation * d.width(),
                             deviation * d.height(), d.scale(j));
  }

  const BasisPursuitProblem& problem_;
  std::span<const double> target_correlations_;
  std::vector<double> metric_;   // W^2
  std::vector<bool> contained_;  // by atom of the dictionary
  std::vector<std::size_t> atoms_;
  std::vector<LobeProfile> profiles_;
  Eigen::MatrixXd gram_;
  Eigen::VectorXd x_;
};

// The squared distance of two atoms' centres over the sum of their squared deviations. Below 1 their columns
// are much alike.
double squared_separation(const GaborDictionary& dictionary, const GaborAtom& a, const GaborAtom& b) {
  const double da = lobe_deviation(a.bandwidth);
  const double db = lobe_deviation(b.bandwidth);
  const double dx = static_cast<double>(a.kx - b.kx) / dictionary.width();
  const double dy = static_cast<double>(a.ky - b.ky) / dictionary.height();
  return (dx * dx + dy * dy) / (da * da + db * db);
}

// The atoms outside the working set that violate optimality most, a_j'r > penalty, in descending order; at
// most 4000.
std::vector<std::size_t> sorted_violators(const BasisPursuitProblem& problem,
                                          std::span<const double> correlations,
                                          const RestrictedProblem& restricted) {
  constexpr std::size_t kMost = 4000;
  std::vector<std::size_t> violators;
  for (std::size_t j = 0; j < correlations.size(); ++j) {
    if (correlations[j] > problem.penalty && !restricted.contains(j)) violators.push_back(j);
  }
  const auto worse = [&](std::size_t a, std::size_t b) {
    return correlations[a] != correlations[b] ? correlations[a] > correlations[b] : a < b;
  };
  const std::size_t sorted = std::min(violators.size(), kMost);
  std::partial_sort(violators.begin(), violators.begin() + static_cast<std::ptrdiff_t>(sorted),
                    violators.end(), worse);
  violators.resize(sorted);
  return violators;
}

// The atoms that enter the working set next: the worst violators, of which no two are much alike. If
// neighbours entered together, most of them would end at zero.
std::vector<std::size_t> next_batch(const GaborDictionary& dictionary,
                                    const std::vector<std::size_t>& violators) {
  constexpr std::size_t kBatch = 60;
  std::vector<std::size_t> chosen;
  for (const std::size_t candidate : violators) {
    if (chosen.size() >= kBatch) break;
    const GaborAtom& atom = dictionary.atom(candidate);
    const bool alone = std::none_of(chosen.begin(), chosen.end(), [&](std::size_t k) {
      return squared_separation(dictionary, atom, dictionary.atom(k)) < 1.0;
    });
    if (alone) chosen.push_back(candidate);
  }
  return chosen;
}

std::vector<std::size_t> positive_entries(std::span<const double> x) {
  std::vector<std::size_t> positive;
  for (std::size_t j = 0; j < x.size(); ++j) {
    if (x[j] > 0.0) positive.push_back(j);
  }
  return positive;
}

// How many factorisations a round may take. While the working set grows, a few are enough: more are better
// spent once the next atoms are known. A few may let none of the new atoms in, and the same atoms would then
// enter for ever, so the budget grows eightfold while P does not fall.
class FactorisationBudget {
 public:
  int solves() const { return solves_; }
  void after_round(bool improved) { solves_ = improved ? kFew : 8 * solves_; }
  bool exhausted() const { return solves_ > 8 * 8 * 8 * 8 * kFew; }

 private:
  static constexpr int kFew = 12;
  int solves_ = kFew;
};

std::vector<double> target_correlations(const BasisPursuitProblem& problem) {
  std::vector<double> correlations(problem.dictionary.size());
  problem.dictionary.analyze(problem.target, correlations);
  return correlations;
}

class WorkingSetPursuit {
 public:
  WorkingSetPursuit(const BasisPursuitProblem& problem, const BasisPursuitOptions& options,
                    std::span<const double> start)
      : problem_(problem),
        options_(options),
        start_(start),
        target_correlations_(target_correlations(problem)),
        restricted_(problem, target_correlations_),
        certificate_(problem),
        correlations_(problem.dictionary.size()) {
    result_.x.assign(problem.dictionary.size(), 0.0);
  }

  BasisPursuitResult run(const Progress& progress) {
    std::vector<std::size_t> entering = positive_entries(start_);
    for (int k = 0;; ++k) {
      restricted_.add(entering, start_);
      const bool solved = restricted_.solve(budget_.solves(), progress);
      restricted_.drop_zeros();
      std::vector<double> x = restricted_.coefficients();
      const double gap = certify(x);
      result_.history.push_back({k, certificate_.primal(), gap});
      const bool improved = k == 0 || certificate_.primal() < result_.primal;
      if (improved) keep(std::move(x));
      update_gap(k);
      budget_.after_round(improved);
      // Rounding in the restricted problem must not loop for ever: no progress is the end.
      const bool stuck = !improved && (solved || budget_.exhausted());
      const bool full = restricted_.atoms().size() >= options_.most_atoms || k >= options_.max_iterations;
      if (!report_gap(progress, gap) || result_.reached || stuck || full) break;
      entering = next_batch(problem_.dictionary, sorted_violators(problem_, correlations_, restricted_));
      if (entering.empty() && solved) break;
    }
    return std::move(result_);
  }

 private:
  // The relative gap at x; correlations_ become A'r with the residual r = s - A x.
  double certify(const std::vector<double>& x) {
    std::vector<double> r(problem_.dictionary.rows());
    problem_.dictionary.synthesize(x, r);
    for (std::size_t i = 0; i < r.size(); ++i) r[i] = problem_.target[i] - r[i];
    problem_.dictionary.analyze(r, correlations_);
    return certificate_.check(r, correlations_, restricted_.sum_x());
  }

  void keep(std::vector<double> x) {
    result_.x = std::move(x);
    result_.primal = certificate_.primal();
  }

  // The bound from below may improve even where x does not.
  void update_gap(int iteration) {
    result_.relative_gap = certificate_.relative_gap_to(result_.primal);
    result_.iterations = iteration;
    result_.reached = result_.relative_gap <= options_.relative_gap;
  }

  // Progress is the share of the wanted gap's decades.
  bool report_gap(const Progress& progress, double gap) const {
    const double done = -std::log10(std::max(gap, 1e-12)) / -std::log10(options_.relative_gap);
    return report(progress, std::min(0.99, done),
                  fmt::format("gap {:.2e}, {} lobes", gap, restricted_.atoms().size()));
  }

  const BasisPursuitProblem& problem_;
  const BasisPursuitOptions& options_;
  std::span<const double> start_;
  std::vector<double> target_correlations_;  // A's
  RestrictedProblem restricted_;
  DualityCertificate certificate_;
  FactorisationBudget budget_;
  std::vector<double> correlations_;  // A'r
  BasisPursuitResult result_;
};

}  // namespace

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
      squared_target_(dot_product(problem.target, problem.target)) {
  problem.dictionary.analyze(std::vector<double>(problem.dictionary.rows(), 1.0), column_sums_);
}

double DualityCertificate::scaled_bound(std::span<const double> r,
                                        std::span<const double> correlations) const {
  const double squared_r = dot_product(r, r);
  const double target_r = dot_product(problem_.target, r);
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
  primal_ = 0.5 * dot_product(r, r) + problem_.penalty * sum_x;
  best_dual_ = std::max({best_dual_, scaled_bound(r, correlations), translated_bound(r, correlations)});
  const double rounding = 1e-10 * (primal_ + 0.5 * squared_target_);
  if (!(primal_ - best_dual_ >= -rounding)) {
    throw WorkError(
        "basis pursuit: the duality gap is negative; the dictionary's transposed product is wrong");
  }
  return relative_gap_to(primal_);
}

double DualityCertificate::relative_gap_to(double primal) const {
  return primal <= 0.0 ? 0.0 : std::max(0.0, (primal - best_dual_) / primal);
}

BasisPursuitResult solve_working_set(const BasisPursuitProblem& problem, const BasisPursuitOptions& options,
                                     const Progress& progress, std::span<const double> start) {
  return WorkingSetPursuit(problem, options, start).run(progress);
}

}  // namespace astrolith
