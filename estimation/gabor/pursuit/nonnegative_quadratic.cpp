#include "estimation/gabor/pursuit/nonnegative_quadratic.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace astrolith {
namespace {

using Indices = std::vector<Eigen::Index>;

// Neighbouring lobes are almost parallel. A very small ridge keeps the factorisation positive.
constexpr double kRidge = 1e-12;

class ActiveSet {
 public:
  ActiveSet(const Eigen::MatrixXd& G, const Eigen::VectorXd& q, Eigen::VectorXd& x, int max_solves,
            const Progress& progress)
      : G_(G),
        q_(q),
        x_(x),
        progress_(progress),
        solves_left_(max_solves),
        tolerance_(1e-12 * q.cwiseAbs().maxCoeff()) {
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      if (x(i) > 0.0) free_.push_back(i);
    }
  }

  // Every round lowers the value, since the best coordinate alone always grows, apart from rounding.
  // Coordinates that enter and leave without lowering the value by more than rounding do not count: they
  // would come back for ever.
  bool minimize() {
    // A start that comes from an earlier solution has a gradient of about this size, which the ridge leaves.
    // It needs no first factorisation.
    if (!free_.empty() && free_gradient() > 100.0 * tolerance_) descend(solve(free_));
    while (solves_left_ > 0) {
      const Eigen::VectorXd descent = q_ - G_ * x_;
      Indices entering;
      for (Eigen::Index i = 0; i < x_.size(); ++i) {
        if (x_(i) <= 0.0 && descent(i) > tolerance_) entering.push_back(i);
      }
      std::sort(entering.begin(), entering.end(), [&](Eigen::Index a, Eigen::Index b) {
        return descent(a) != descent(b) ? descent(a) > descent(b) : a < b;
      });
      bool lowered = enter_and_lower(entering);
      for (std::size_t k = 0; !lowered && k < entering.size(); ++k) {
        if (x_(entering[k]) <= 0.0) lowered = enter_and_lower({entering[k]});
      }
      if (!lowered) return solves_left_ > 0;
    }
    return false;
  }

 private:
  double free_gradient() const {
    const Eigen::VectorXd descent = q_ - G_ * x_;
    double largest = 0.0;
    for (const Eigen::Index i : free_) largest = std::max(largest, std::abs(descent(i)));
    return largest;
  }

  double value_at(const Eigen::VectorXd& x) const { return x.dot(0.5 * (G_ * x) - q_); }

  // The minimum over these coordinates with any signs.
  Eigen::VectorXd solve(const Indices& at) {
    --solves_left_;
    if (!report(progress_, 0.0, "heights of lobes")) solves_left_ = 0;
    const auto n = static_cast<Eigen::Index>(at.size());
    Eigen::MatrixXd block = G_(at, at);
    block.diagonal() *= 1.0 + kRidge;
    const Eigen::VectorXd right = q_(at);
    // The blocked factorisation is several times faster than the pivoted one, which serves blocks without
    // full rank.
    const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> cholesky(block);
    if (n > 0 && cholesky.info() == Eigen::Success) return cholesky.solve(right);
    block = G_(at, at);
    block.diagonal() *= 1.0 + kRidge;
    return block.ldlt().solve(right);
  }

  bool enter_and_lower(const Indices& entering) {
    const double before = value_at(x_);
    return enter(entering) && value_at(x_) < before - 1e-14 * std::abs(before);
  }

  // Adds the coordinates of `entering`, which are at zero, to the free set as far as they grow together, and
  // descends. Returns whether any of them grows.
  bool enter(Indices entering) {
    while (!entering.empty() && solves_left_ > 0) {
      Indices trial = free_;
      trial.insert(trial.end(), entering.begin(), entering.end());
      Eigen::VectorXd z = solve(trial);
      Indices growing;
      for (std::size_t k = free_.size(); k < trial.size(); ++k) {
        if (z(static_cast<Eigen::Index>(k)) > 0.0) growing.push_back(trial[k]);
      }
      if (growing.size() == entering.size()) {
        free_ = std::move(trial);
        descend(std::move(z));
        return true;
      }
      // The list is at least halved, and keeps the best, so that few factorisations find those that grow.
      growing.resize(std::min(growing.size(), entering.size() / 2));
      entering = std::move(growing);
    }
    return false;
  }

  // Moves towards z, the minimum over the free coordinates, until a minimum without negative coordinates is
  // reached. The step to the boundary never raises the value. The cut at zero drops many coordinates for one
  // factorisation and is taken where its value is no higher.
  void descend(Eigen::VectorXd z) {
    while (z.size() > 0 && z.minCoeff() <= 0.0) {
      Indices free_after_cut = free_;
      Eigen::VectorXd after_cut = x_;
      cut_at_zero(z, free_after_cut, after_cut);
      step_to_boundary(z);
      if (value_at(after_cut) <= value_at(x_)) {
        free_ = std::move(free_after_cut);
        x_ = std::move(after_cut);
      }
      if (solves_left_ <= 0) return;
      z = solve(free_);
    }
    for (std::size_t k = 0; k < free_.size(); ++k) x_(free_[k]) = z(static_cast<Eigen::Index>(k));
  }

  static void cut_at_zero(const Eigen::VectorXd& z, Indices& free, Eigen::VectorXd& x) {
    Indices kept;
    for (std::size_t k = 0; k < free.size(); ++k) {
      x(free[k]) = std::max(0.0, z(static_cast<Eigen::Index>(k)));
      if (x(free[k]) > 0.0) kept.push_back(free[k]);
    }
    free = std::move(kept);
  }

  // Moves x towards z until the first coordinate reaches zero. Coordinates at zero leave the free set.
  void step_to_boundary(const Eigen::VectorXd& z) {
    double length = 1.0;
    for (std::size_t k = 0; k < free_.size(); ++k) {
      const double target = z(static_cast<Eigen::Index>(k));
      const double value = x_(free_[k]);
      if (target <= 0.0) length = value == 0.0 ? 0.0 : std::min(length, value / (value - target));
    }
    Indices kept;
    for (std::size_t k = 0; k < free_.size(); ++k) {
      const double target = z(static_cast<Eigen::Index>(k));
      double& value = x_(free_[k]);
      // This is the quotient whose least is the length. A product could round, and nothing would leave.
      const bool leaves = target <= 0.0 && (value == 0.0 || value / (value - target) <= length);
      value = leaves ? 0.0 : std::max(0.0, value + length * (target - value));
      if (!leaves) kept.push_back(free_[k]);
    }
    free_ = std::move(kept);
  }

  const Eigen::MatrixXd& G_;
  const Eigen::VectorXd& q_;
  Eigen::VectorXd& x_;
  const Progress& progress_;
  int solves_left_;
  double tolerance_;
  Indices free_;
};

}  // namespace

bool minimize_nonnegative_quadratic(const Eigen::MatrixXd& G, const Eigen::VectorXd& q, Eigen::VectorXd& x,
                                    int max_solves, const Progress& progress) {
  return ActiveSet(G, q, x, max_solves, progress).minimize();
}

}  // namespace astrolith
