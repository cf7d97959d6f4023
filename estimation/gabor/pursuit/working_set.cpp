#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "estimation/gabor/pursuit/basis_pursuit.h"
#include "estimation/gabor/pursuit/duality_certificate.h"
#include "estimation/gabor/pursuit/lobe_overlap.h"
#include "estimation/gabor/pursuit/nonnegative_quadratic.h"
#include "numerics/parallel_for.h"

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
  const Eigen::VectorXd& x() const { return x_; }

  void add(const std::vector<std::size_t>& atoms, std::span<const double> start) {
    const auto old = static_cast<Eigen::Index>(atoms_.size());
    for (const std::size_t j : atoms) {
      atoms_.push_back(j);
      contained_[j] = true;
      profiles_.push_back(profile(j));
    }
    const auto n = static_cast<Eigen::Index>(atoms_.size());
    gram_.conservativeResize(n, n);
    x_.conservativeResize(n);
    for (Eigen::Index i = old; i < n; ++i)
      x_(i) = start.empty() ? 0.0 : start[atoms_[static_cast<std::size_t>(i)]];
    parallel_for(old, n, [&](std::int64_t row) {
      for (Eigen::Index column = 0; column <= row; ++column) {
        const double product = row == column ? 1.0
                                             : lobe_overlap(metric_, profiles_[static_cast<std::size_t>(row)],
                                                            profiles_[static_cast<std::size_t>(column)]);
        gram_(row, column) = gram_(column, row) = product;
      }
    });
  }

  // Returns whether the minimum was reached within so many factorisations: while the working set still grows,
  // more than a few are better spent after its next atoms are known.
  bool solve(int max_solves) {
    Eigen::VectorXd q(x_.size());
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      q(i) = target_correlations_[atoms_[static_cast<std::size_t>(i)]] - problem_.penalty;
    }
    return q.size() == 0 || minimize_nonnegative_quadratic(gram_, q, x_, max_solves);
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
  LobeProfile profile(std::size_t j) const {
    const GaborDictionary& d = problem_.dictionary;
    const GaborAtom& atom = d.atom(j);
    const double deviation = lobe_deviation(atom.bandwidth);
    return make_lobe_profile(d.width(), d.height(), atom.kx, atom.ky, deviation * d.width(),
                             deviation * d.height(), d.scale(j));
  }

  const BasisPursuitProblem& problem_;
  std::span<const double> target_correlations_;
  std::vector<double> metric_;
  std::vector<bool> contained_;
  std::vector<std::size_t> atoms_;
  std::vector<LobeProfile> profiles_;
  Eigen::MatrixXd gram_;
  Eigen::VectorXd x_;
};

// Squared distance of two atoms' centres in joint deviations; below 1 their columns are much alike.
double squared_separation(const GaborDictionary& dictionary, const GaborAtom& a, const GaborAtom& b) {
  const double da = lobe_deviation(a.bandwidth);
  const double db = lobe_deviation(b.bandwidth);
  const double dx = static_cast<double>(a.kx - b.kx) / dictionary.width();
  const double dy = static_cast<double>(a.ky - b.ky) / dictionary.height();
  return (dx * dx + dy * dy) / (da * da + db * db);
}

// The atoms that violate optimality most, a_j'r > penalty, no two of them much alike: adding neighbours
// together mostly adds atoms that end at zero.
std::vector<std::size_t> worst_violators(const BasisPursuitProblem& problem,
                                         std::span<const double> correlations,
                                         const RestrictedProblem& restricted) {
  constexpr std::size_t kBatch = 60;
  constexpr std::size_t kCandidates = 4000;
  std::vector<std::size_t> candidates;
  for (std::size_t j = 0; j < correlations.size(); ++j) {
    if (correlations[j] > problem.penalty && !restricted.contains(j)) candidates.push_back(j);
  }
  const auto worse = [&](std::size_t a, std::size_t b) {
    return correlations[a] != correlations[b] ? correlations[a] > correlations[b] : a < b;
  };
  const std::size_t sorted = std::min(candidates.size(), kCandidates);
  std::partial_sort(candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(sorted),
                    candidates.end(), worse);
  std::vector<std::size_t> chosen;
  for (std::size_t c = 0; c < sorted && chosen.size() < kBatch; ++c) {
    const GaborAtom& atom = problem.dictionary.atom(candidates[c]);
    const bool alone = std::none_of(chosen.begin(), chosen.end(), [&](std::size_t k) {
      return squared_separation(problem.dictionary, atom, problem.dictionary.atom(k)) < 1.0;
    });
    if (alone) chosen.push_back(candidates[c]);
  }
  return chosen;
}

}  // namespace

BasisPursuitResult solve_working_set(const BasisPursuitProblem& problem, const BasisPursuitOptions& options,
                                     const Progress& progress, std::span<const double> start) {
  const GaborDictionary& dictionary = problem.dictionary;
  std::vector<double> correlations(dictionary.size());
  std::vector<double> target_correlations(dictionary.size());
  dictionary.analyze(problem.target, target_correlations);
  RestrictedProblem restricted(problem, target_correlations);
  std::vector<std::size_t> entering;
  for (std::size_t j = 0; j < start.size(); ++j) {
    if (start[j] > 0.0) entering.push_back(j);
  }
  DualityCertificate certificate(problem);
  BasisPursuitResult result;
  result.x.assign(dictionary.size(), 0.0);
  std::vector<double> r(dictionary.rows());
  double best_primal = 0.0;
  constexpr int kFewSolves = 12;
  int solves = kFewSolves;
  for (int k = 0;; ++k) {
    restricted.add(entering, start);
    const bool solved = restricted.solve(solves);
    restricted.drop_zeros();
    std::vector<double> x(dictionary.size(), 0.0);
    double sum = 0.0;
    for (std::size_t i = 0; i < restricted.atoms().size(); ++i) {
      x[restricted.atoms()[i]] = restricted.x()(static_cast<Eigen::Index>(i));
      sum += restricted.x()(static_cast<Eigen::Index>(i));
    }
    dictionary.synthesize(x, r);
    for (std::size_t i = 0; i < r.size(); ++i) r[i] = problem.target[i] - r[i];
    dictionary.analyze(r, correlations);
    const double gap = certificate.check(r, correlations, sum);
    result.history.push_back({k, certificate.primal(), gap});
    // Rounding in the small problem must not loop for ever: no progress is the end.
    const bool progressed = k == 0 || certificate.primal() < best_primal;
    if (progressed) {
      best_primal = certificate.primal();
      result.x = std::move(x);
      result.primal = certificate.primal();
    }
    // The bound from below may improve even where x does not.
    result.relative_gap = certificate.relative_gap_of(best_primal);
    result.iterations = k;
    result.reached = result.relative_gap <= options.relative_gap;
    const bool go_on = report(
        progress, std::min(0.99, -std::log10(std::max(gap, 1e-12)) / -std::log10(options.relative_gap)),
        fmt::format("gap {:.2e}, {} lobes", gap, restricted.atoms().size()));
    // Few factorisations may not be enough to let any of the new atoms in, and the same would enter for ever.
    solves = progressed ? kFewSolves : 8 * solves;
    const bool stuck = !progressed && (solved || solves > 8 * 8 * 8 * 8 * kFewSolves);
    if (result.reached || !go_on || stuck || k >= options.max_iterations) break;
    entering = worst_violators(problem, correlations, restricted);
    if (entering.empty() && solved) break;
  }
  return result;
}

}  // namespace astrolith
