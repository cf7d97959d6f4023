#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "estimation/gabor/pursuit/basis_pursuit.h"
#include "estimation/gabor/pursuit/duality_certificate.h"

namespace astrolith {
namespace {

// An upper bound on the largest eigenvalue of A'A. For a matrix without negative entries and any positive v
// it is at most max_j (A'A v)_j / v_j (Collatz and Wielandt); power iterations make that bound tight.
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
    // A floor keeps v positive; any positive v gives a valid bound.
    for (std::size_t j = 0; j < v.size(); ++j) v[j] = std::max(next[j] / largest, 1e-6);
  }
  return bound;
}

struct Iterate {
  std::vector<double> x;      // coefficients
  std::vector<double> image;  // A x: kept, so that extrapolation costs no product
};

}  // namespace

BasisPursuitResult solve_fista(const BasisPursuitProblem& problem, const BasisPursuitOptions& options,
                               const Progress& progress) {
  constexpr int kCheckEvery = 10;
  const GaborDictionary& dictionary = problem.dictionary;
  const double step = 1.0 / largest_eigenvalue_bound(dictionary);
  DualityCertificate certificate(problem);
  Iterate now{std::vector<double>(dictionary.size(), 0.0), std::vector<double>(dictionary.rows(), 0.0)};
  Iterate previous = now;
  Iterate ahead = now;  // the extrapolated point
  std::vector<double> r(dictionary.rows());
  std::vector<double> gradient(dictionary.size());  // A'r: the negative gradient of the quadratic
  const auto residual_of = [&](const Iterate& at) {
    for (std::size_t i = 0; i < r.size(); ++i) r[i] = problem.target[i] - at.image[i];
    dictionary.analyze(r, gradient);
  };

  BasisPursuitResult result;
  double momentum = 1.0;
  for (int k = 0;; ++k) {
    if (k % kCheckEvery == 0) {
      residual_of(now);
      double sum = 0.0;
      for (const double x : now.x) sum += x;
      result.relative_gap = certificate.check(r, gradient, sum);
      result.primal = certificate.primal();
      result.iterations = k;
      result.history.push_back({k, result.primal, result.relative_gap});
      result.reached = result.relative_gap <= options.relative_gap;
      const bool go_on = report(progress, static_cast<double>(k) / options.max_iterations,
                                fmt::format("gap {:.2e}", result.relative_gap));
      if (result.reached || !go_on || k >= options.max_iterations) break;
    }
    residual_of(ahead);
    std::swap(previous, now);
    double uphill = 0.0;  // (ahead - now)'(now - previous): positive when momentum points uphill
    for (std::size_t j = 0; j < now.x.size(); ++j) {
      now.x[j] = std::max(0.0, ahead.x[j] + step * (gradient[j] - problem.penalty));
      uphill += (ahead.x[j] - now.x[j]) * (now.x[j] - previous.x[j]);
    }
    dictionary.synthesize(now.x, now.image);
    const double next_momentum =
        uphill > 0.0 ? 1.0 : 0.5 * (1.0 + std::sqrt(1.0 + 4.0 * momentum * momentum));
    const double extrapolation = uphill > 0.0 ? 0.0 : (momentum - 1.0) / next_momentum;
    momentum = next_momentum;
    for (std::size_t j = 0; j < now.x.size(); ++j) {
      ahead.x[j] = now.x[j] + extrapolation * (now.x[j] - previous.x[j]);
    }
    for (std::size_t i = 0; i < now.image.size(); ++i) {
      ahead.image[i] = now.image[i] + extrapolation * (now.image[i] - previous.image[i]);
    }
  }
  result.x = std::move(now.x);
  return result;
}

}  // namespace astrolith
