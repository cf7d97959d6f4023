// (mu/mu_w, lambda)-CMA-ES with the default parameters of Hansen, "The CMA evolution strategy: a tutorial"
// (arXiv:1604.00772), whose numbers of equations are cited below, and restarts of doubled population (Auger
// and Hansen, "A restart CMA evolution strategy with increasing population size", CEC 2005).
//
// The search runs over the free variables scaled to [0, 1]. A sample beyond a wall is evaluated at its mirror
// image. The objective is thus continued evenly, and the strategy itself knows no walls.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "estimation/optimize/best_so_far_internal.h"
#include "estimation/optimize/cma_es_internal.h"
#include "numerics/hash_random.h"

namespace astrolith {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// The first step and the largest one, as shares of the box's sides.
constexpr double kFirstStep = 0.3;
constexpr double kLargestStep = 1.0;

// A restart is due once the steps are this small, or the covariance this far from round.
constexpr double kSmallestStep = 1e-11;
constexpr double kLargestCondition = 1e14;
// A restart is also due once the best values of `patience` generations, and all values of the last
// generation, differ by no more than this share.
constexpr double kFlat = 1e-12;

double mirrored(double y) {
  const double period = std::fmod(std::abs(y), 2.0);
  return period <= 1.0 ? period : 2.0 - period;
}

// The variables that are not fixed, scaled to [0, 1].
class FreeVariables {
 public:
  explicit FreeVariables(const Bounds& bounds) : bounds_(bounds) {
    for (std::size_t d = 0; d < bounds.lower.size(); ++d) {
      if (bounds.upper[d] > bounds.lower[d]) free_.push_back(d);
    }
  }

  Eigen::Index count() const { return static_cast<Eigen::Index>(free_.size()); }

  std::vector<double> to_box(const VectorXd& y) const {
    std::vector<double> x = bounds_.lower;
    for (std::size_t i = 0; i < free_.size(); ++i) {
      const std::size_t d = free_[i];
      const double inside = x[d] + mirrored(y[static_cast<Eigen::Index>(i)]) * (bounds_.upper[d] - x[d]);
      x[d] = std::min(inside, bounds_.upper[d]);
    }
    return x;
  }

  VectorXd from_box(const std::vector<double>& x) const {
    VectorXd y(count());
    for (std::size_t i = 0; i < free_.size(); ++i) {
      const std::size_t d = free_[i];
      y[static_cast<Eigen::Index>(i)] = (x[d] - bounds_.lower[d]) / (bounds_.upper[d] - bounds_.lower[d]);
    }
    return y;
  }

 private:
  const Bounds& bounds_;
  std::vector<std::size_t> free_;
};

// Constants of one population size (tutorial, table 1).
struct Strategy {
  Strategy(int lambda, double n) : samples(lambda), parents(lambda / 2), weights(lambda) {
    for (int i = 0; i < lambda; ++i) weights[i] = std::log((lambda + 1) / 2.0) - std::log(i + 1.0);  // eq. 49
    auto better = weights.head(parents);
    auto worse = weights.tail(lambda - parents);
    const double mu_eff_worse = worse.sum() * worse.sum() / worse.squaredNorm();
    better /= better.sum();
    mu_eff = 1.0 / better.squaredNorm();
    c_sigma = (mu_eff + 2) / (n + mu_eff + 5);
    d_sigma = 1 + 2 * std::max(0.0, std::sqrt((mu_eff - 1) / (n + 1)) - 1) + c_sigma;
    c_c = (4 + mu_eff / n) / (n + 4 + 2 * mu_eff / n);
    c_1 = 2 / ((n + 1.3) * (n + 1.3) + mu_eff);
    c_mu = std::min(1 - c_1, 2 * (0.25 + mu_eff - 2 + 1 / mu_eff) / ((n + 2) * (n + 2) + mu_eff));
    // The largest sum of negative weights that leaves C positive definite (eq. 50 to 53).
    const double negative_sum =
        std::min({1 + c_1 / c_mu, 1 + 2 * mu_eff_worse / (mu_eff + 2), (1 - c_1 - c_mu) / (n * c_mu)});
    worse *= negative_sum / worse.cwiseAbs().sum();
    expected_length = std::sqrt(n) * (1 - 1 / (4 * n) + 1 / (21 * n * n));
    patience = 10 + static_cast<std::size_t>(std::ceil(30 * n / lambda));
  }

  int samples, parents;
  VectorXd weights;  // best first: positive for the parents, negative for the others
  double mu_eff, c_sigma, d_sigma, c_c, c_1, c_mu;
  double expected_length;  // E |N(0, I)|
  std::size_t patience;    // generations without progress before a restart
};

struct Sample {
  VectorXd y;
  std::vector<double> x;
  double value = 0;
};

// The sampling distribution N(mean, sigma^2 C) and its paths.
class Distribution {
 public:
  explicit Distribution(VectorXd mean)
      : mean_(std::move(mean)),
        path_sigma_(VectorXd::Zero(mean_.size())),
        path_c_(path_sigma_),
        covariance_(MatrixXd::Identity(mean_.size(), mean_.size())),
        axes_(covariance_),
        lengths_(VectorXd::Ones(mean_.size())) {}

  const VectorXd& mean() const { return mean_; }

  VectorXd draw(CounterRandom random) const {
    VectorXd z(mean_.size());
    for (double& v : z) v = random.normal();
    return mean_ + sigma_ * (axes_ * lengths_.cwiseProduct(z));  // eq. 5 with C = B D^2 B^T
  }

  // Updates mean, paths, covariance and step size from all samples of a generation, the best first.
  void update(const Strategy& s, std::span<const Sample> samples) {
    ++generation_;
    const VectorXd old_mean = mean_;
    mean_.setZero();
    for (int i = 0; i < s.parents; ++i) mean_ += s.weights[i] * samples[std::size_t(i)].y;  // eq. 6
    const VectorXd step = (mean_ - old_mean) / sigma_;
    path_sigma_ = (1 - s.c_sigma) * path_sigma_ +
                  std::sqrt(s.c_sigma * (2 - s.c_sigma) * s.mu_eff) * whitened(step);  // eq. 43
    const double length = path_sigma_.norm();
    const double settled = std::sqrt(1 - std::pow(1 - s.c_sigma, 2.0 * generation_));
    const double n = static_cast<double>(mean_.size());
    const bool stalls = length / settled >= (1.4 + 2 / (n + 1)) * s.expected_length;  // h_sigma = 0
    path_c_ *= 1 - s.c_c;
    if (!stalls) path_c_ += std::sqrt(s.c_c * (2 - s.c_c) * s.mu_eff) * step;  // eq. 45
    adapt_covariance(s, samples, old_mean, stalls);
    sigma_ *= std::exp(s.c_sigma / s.d_sigma * (length / s.expected_length - 1));  // eq. 44
    sigma_ = std::min(sigma_, kLargestStep);
    decompose();
  }

  bool exhausted() const {
    return !(sigma_ * lengths_.maxCoeff() > kSmallestStep) ||
           !(lengths_.maxCoeff() < std::sqrt(kLargestCondition) * lengths_.minCoeff());
  }

 private:
  // C^-1/2 v
  VectorXd whitened(const VectorXd& v) const {
    return axes_ * (axes_.transpose() * v).cwiseQuotient(lengths_);
  }

  // Updates the covariance (eq. 47).
  void adapt_covariance(const Strategy& s, std::span<const Sample> samples, const VectorXd& old_mean,
                        bool stalls) {
    const double n = static_cast<double>(mean_.size());
    MatrixXd change = s.c_1 * path_c_ * path_c_.transpose();
    const double decay = s.c_1 + s.c_mu * s.weights.sum() - (stalls ? s.c_1 * s.c_c * (2 - s.c_c) : 0.0);
    for (int i = 0; i < s.samples; ++i) {
      const VectorXd y = (samples[std::size_t(i)].y - old_mean) / sigma_;
      const double weight =
          s.weights[i] >= 0 ? s.weights[i] : s.weights[i] * n / std::max(whitened(y).squaredNorm(), 1e-300);
      change += s.c_mu * weight * y * y.transpose();
    }
    covariance_ = (1 - decay) * covariance_ + change;
  }

  void decompose() {
    covariance_ = 0.5 * (covariance_ + covariance_.transpose().eval());
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(covariance_);
    axes_ = solver.eigenvectors();
    lengths_ = solver.eigenvalues().cwiseMax(1e-300).cwiseSqrt();
  }

  VectorXd mean_, path_sigma_, path_c_;
  MatrixXd covariance_, axes_;
  VectorXd lengths_;
  double sigma_ = kFirstStep;
  int generation_ = 0;
};

class CmaEs {
 public:
  CmaEs(const BatchObjective& objective, const Bounds& bounds, const OptimizeOptions& options,
        const Progress& progress)
      : objective_(objective), variables_(bounds), options_(options), best_(options, progress) {}

  OptimizeResult run() {
    if (variables_.count() == 0) return run_fixed();
    const double n = static_cast<double>(variables_.count());
    int lambda = options_.population > 0 ? std::max(options_.population, 4)
                                         : 4 + static_cast<int>(std::floor(3 * std::log(n)));
    bool from_start = !options_.start.empty();
    while (descend(Strategy(lambda, n), from_start)) {
      lambda *= 2;
      from_start = false;
    }
    return best_.result();
  }

 private:
  // Evaluates the only point there is when every variable is fixed.
  OptimizeResult run_fixed() {
    std::vector<Sample> only(1);
    only[0].y = VectorXd(0);
    evaluate(only);
    if (best_.generation_done()) best_.end(OptimizeTermination::converged);
    return best_.result();
  }

  // Runs one descent from a random point, or from the given start. Returns false when the whole run is to
  // end.
  bool descend(const Strategy& strategy, bool from_start) {
    Distribution distribution(from_start ? variables_.from_box(options_.start) : random_mean());
    std::vector<double> bests;
    for (bool first = true;; first = false) {
      std::vector<Sample> samples = draw(strategy, distribution);
      if (first && from_start) samples[0] = {distribution.mean(), options_.start, 0.0};
      evaluate(samples);
      if (!best_.generation_done()) return false;
      std::stable_sort(samples.begin(), samples.end(),
                       [](const Sample& a, const Sample& b) { return a.value < b.value; });
      distribution.update(strategy, samples);
      bests.push_back(samples.front().value);
      if (distribution.exhausted() || is_flat(strategy, bests, samples.back().value)) return true;
    }
  }

  VectorXd random_mean() {
    CounterRandom random(options_.seed, ++stream_);
    VectorXd mean(variables_.count());
    for (double& v : mean) v = random.uniform();
    return mean;
  }

  // Draws a generation, or as many samples as the budget still allows.
  std::vector<Sample> draw(const Strategy& strategy, const Distribution& distribution) {
    const std::int64_t left = options_.max_evaluations - best_.result().evaluations;
    std::vector<Sample> samples(static_cast<std::size_t>(std::min<std::int64_t>(strategy.samples, left)));
    for (Sample& s : samples) s.y = distribution.draw(CounterRandom(options_.seed, ++stream_));
    return samples;
  }

  void evaluate(std::vector<Sample>& samples) {
    std::vector<std::vector<double>> points;
    for (Sample& s : samples) {
      if (s.x.empty()) s.x = variables_.to_box(s.y);
      points.push_back(s.x);
    }
    const std::vector<double> values = objective_(points);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      samples[i].value = finite_or_infinity(values[i]);
      best_.record(samples[i].x, samples[i].value);
    }
  }

  static bool is_flat(const Strategy& strategy, const std::vector<double>& bests, double worst) {
    if (bests.size() < strategy.patience) return false;
    const auto recent = std::span(bests).last(strategy.patience);
    const auto [low, high] = std::minmax_element(recent.begin(), recent.end());
    return !(std::max(*high, worst) - *low > kFlat * std::max(std::abs(*low), 1e-12));  // also for infinities
  }

  const BatchObjective& objective_;
  FreeVariables variables_;
  const OptimizeOptions& options_;
  BestSoFar best_;
  std::uint64_t stream_ = 0;
};

}  // namespace

OptimizeResult cma_es(const BatchObjective& objective, const Bounds& bounds, const OptimizeOptions& options,
                      const Progress& progress) {
  return CmaEs(objective, bounds, options, progress).run();
}

}  // namespace astrolith
