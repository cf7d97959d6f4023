#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "estimation/gabor/pursuit/basis_pursuit.h"
#include "estimation/gabor/pursuit/duality_certificate.h"

namespace astrolith {
namespace {

// An upper bound on the largest eigenvalue of A'A. If a matrix has no negative entries, its largest
// eigenvalue is at most max_j (A'A v)_j / v_j for any positive v (Collatz and Wielandt). Power iterations
// make this bound tight.
double largest_eigenvalue_bound(const GaborDictionary& dictionary) {
  constexpr int kIterations = 40;
  std::vector<double> v(dictionary.size(), 1.0);
  std::vector<double> image(dictionary.rows());
  std::vector<double> next(dictionary.size());
  double bound = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kIterations; ++i) {
    dictionary.synthesize(v, image);
    dictionary.analyze(image, next);
    double ratio = 0.0;
    double largest = 0.0;
    for (std::size_t j = 0; j < v.size(); ++j) {
      ratio = std::max(ratio, next[j] / v[j]);
      largest = std::max(largest, next[j]);
    }
    bound = std::min(bound, ratio);
    // A floor keeps v positive, as the bound needs.
    for (std::size_t j = 0; j < v.size(); ++j) v[j] = std::max(next[j] / largest, 1e-6);
  }
  return bound;
}

struct Iterate {
  std::vector<double> x;      // coefficients
  std::vector<double> image;  // A x, kept so that extrapolation costs no product
};

double sum_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return sum;
}

// out = a + factor * (a - b)
void extrapolate(const std::vector<double>& a, const std::vector<double>& b, double factor,
                 std::vector<double>& out) {
  for (std::size_t i = 0; i < a.size(); ++i) out[i] = a[i] + factor * (a[i] - b[i]);
}

class Fista {
 public:
  explicit Fista(const BasisPursuitProblem& problem)
      : problem_(problem),
        step_(1.0 / largest_eigenvalue_bound(problem.dictionary)),
        certificate_(problem),
        now_{std::vector<double>(problem.dictionary.size(), 0.0),
             std::vector<double>(problem.dictionary.rows(), 0.0)},
        previous_(now_),
        ahead_(now_),
        r_(problem.dictionary.rows()),
        gradient_(problem.dictionary.size()) {}

  BasisPursuitResult run(const BasisPursuitOptions& options, const Progress& progress) {
    constexpr int kCheckEvery = 10;
    BasisPursuitResult result;
    for (int k = 0;; ++k) {
      if (k % kCheckEvery == 0) {
        certify(k, result);
        result.reached = result.relative_gap <= options.relative_gap;
        const bool go_on = report(progress, static_cast<double>(k) / options.max_iterations,
                                  fmt::format("gap {:.2e}", result.relative_gap));
        if (result.reached || !go_on || k >= options.max_iterations) break;
      }
      const bool uphill = proximal_step();
      accelerate(uphill);
    }
    result.x = std::move(now_.x);
    return result;
  }

 private:
  void certify(int iteration, BasisPursuitResult& result) {
    update_gradient(now_);
    result.relative_gap = certificate_.check(r_, gradient_, sum_of(now_.x));
    result.primal = certificate_.primal();
    result.iterations = iteration;
    result.history.push_back({iteration, result.primal, result.relative_gap});
  }

  void update_gradient(const Iterate& at) {
    for (std::size_t i = 0; i < r_.size(); ++i) r_[i] = problem_.target[i] - at.image[i];
    problem_.dictionary.analyze(r_, gradient_);
  }

  // x = (ahead + step (A'r - penalty))+. Returns whether momentum points uphill:
  // (ahead - now)'(now - previous) > 0.
  bool proximal_step() {
    update_gradient(ahead_);
    std::swap(previous_, now_);
    double uphill = 0.0;
    for (std::size_t j = 0; j < now_.x.size(); ++j) {
      now_.x[j] = std::max(0.0, ahead_.x[j] + step_ * (gradient_[j] - problem_.penalty));
      uphill += (ahead_.x[j] - now_.x[j]) * (now_.x[j] - previous_.x[j]);
    }
    problem_.dictionary.synthesize(now_.x, now_.image);
    return uphill > 0.0;
  }

  // Extrapolates by the momentum of Beck and Teboulle, or begins with none where it pointed uphill.
  void accelerate(bool restart) {
    const double next = restart ? 1.0 : 0.5 * (1.0 + std::sqrt(1.0 + 4.0 * momentum_ * momentum_));
    const double factor = restart ? 0.0 : (momentum_ - 1.0) / next;
    momentum_ = next;
    extrapolate(now_.x, previous_.x, factor, ahead_.x);
    extrapolate(now_.image, previous_.image, factor, ahead_.image);
  }

  const BasisPursuitProblem& problem_;
  double step_;
  DualityCertificate certificate_;
  Iterate now_, previous_, ahead_;  // ahead_ is the extrapolated point
  std::vector<double> r_;           // residual s - A x
  std::vector<double> gradient_;    // A'r, the negative gradient of the quadratic
  double momentum_ = 1.0;
};

}  // namespace

BasisPursuitResult solve_fista(const BasisPursuitProblem& problem, const BasisPursuitOptions& options,
                               const Progress& progress) {
  return Fista(problem).run(options, progress);
}

}  // namespace astrolith
