#include "estimation/gabor/nonnegative_quadratic.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <vector>

namespace astrolith {
namespace {

// Neighbouring lobes are almost parallel: a hint of a ridge keeps the factorisation positive.
constexpr double kRidge = 1e-12;

Eigen::VectorXd solve_free_block(const Eigen::MatrixXd& G, const Eigen::VectorXd& q,
                                 const std::vector<Eigen::Index>& free) {
  const auto n = static_cast<Eigen::Index>(free.size());
  Eigen::MatrixXd block(n, n);
  Eigen::VectorXd right(n);
  for (Eigen::Index c = 0; c < n; ++c) {
    for (Eigen::Index r = 0; r < n; ++r)
      block(r, c) = G(free[static_cast<std::size_t>(r)], free[static_cast<std::size_t>(c)]);
    block(c, c) *= 1.0 + kRidge;
    right(c) = q(free[static_cast<std::size_t>(c)]);
  }
  // Blocked, and several times faster than the pivoted factorisation that is left for a block without full
  // rank.
  const Eigen::LLT<Eigen::MatrixXd> cholesky(block);
  if (cholesky.info() == Eigen::Success) return cholesky.solve(right);
  return block.ldlt().solve(right);
}

// Moves x towards z on the free coordinates until the first reaches zero; those at zero leave the free set.
void step_to_boundary(const Eigen::VectorXd& z, std::vector<Eigen::Index>& free, Eigen::VectorXd& x) {
  double length = 1.0;
  for (std::size_t k = 0; k < free.size(); ++k) {
    const double target = z(static_cast<Eigen::Index>(k));
    if (target <= 0.0) length = std::min(length, x(free[k]) / (x(free[k]) - target));
  }
  std::vector<Eigen::Index> kept;
  for (std::size_t k = 0; k < free.size(); ++k) {
    const double target = z(static_cast<Eigen::Index>(k));
    double& value = x(free[k]);
    const bool leaves = target <= 0.0 && value / (value - target) <= length;
    value = leaves ? 0.0 : std::max(0.0, value + length * (target - value));
    if (!leaves) kept.push_back(free[k]);
  }
  free = std::move(kept);
}

double value_of(const Eigen::MatrixXd& G, const Eigen::VectorXd& q, const Eigen::VectorXd& x) {
  return x.dot(0.5 * (G * x) - q);
}

// Cuts z at zero, and so drops many coordinates at once.
void cut_at_zero(const Eigen::VectorXd& z, std::vector<Eigen::Index>& free, Eigen::VectorXd& x) {
  std::vector<Eigen::Index> kept;
  for (std::size_t k = 0; k < free.size(); ++k) {
    x(free[k]) = std::max(0.0, z(static_cast<Eigen::Index>(k)));
    if (x(free[k]) > 0.0) kept.push_back(free[k]);
  }
  free = std::move(kept);
}

// Minimises over the free coordinates, none of which may end below zero. The step to the boundary never
// raises the value; the cut, which saves factorisations, is taken where it is no worse.
void descend(const Eigen::MatrixXd& G, const Eigen::VectorXd& q, std::vector<Eigen::Index>& free,
             Eigen::VectorXd& x) {
  while (!free.empty()) {
    const Eigen::VectorXd z = solve_free_block(G, q, free);
    if (z.minCoeff() > 0.0) {
      for (std::size_t k = 0; k < free.size(); ++k) x(free[k]) = z(static_cast<Eigen::Index>(k));
      return;
    }
    std::vector<Eigen::Index> free_after_cut = free;
    Eigen::VectorXd after_cut = x;
    cut_at_zero(z, free_after_cut, after_cut);
    step_to_boundary(z, free, x);
    if (value_of(G, q, after_cut) <= value_of(G, q, x)) {
      free = std::move(free_after_cut);
      x = std::move(after_cut);
    }
  }
}

// Lets those of `entering` (at zero now) into the free set that grow together; returns whether any does.
bool enter(const Eigen::MatrixXd& G, const Eigen::VectorXd& q, std::vector<Eigen::Index> entering,
           std::vector<Eigen::Index>& free) {
  while (!entering.empty()) {
    std::vector<Eigen::Index> trial = free;
    trial.insert(trial.end(), entering.begin(), entering.end());
    const Eigen::VectorXd z = solve_free_block(G, q, trial);
    std::vector<Eigen::Index> growing;
    for (std::size_t k = free.size(); k < trial.size(); ++k) {
      if (z(static_cast<Eigen::Index>(k)) > 0.0) growing.push_back(trial[k]);
    }
    if (growing.size() == entering.size()) {
      free = std::move(trial);
      return true;
    }
    entering = std::move(growing);
  }
  return false;
}

}  // namespace

// Active sets (Lawson and Hanson 1974), with many coordinates entering at once while that works: the best one
// alone always grows but for rounding, so every round lowers the value and the rounds end.
void minimize_nonnegative_quadratic(const Eigen::MatrixXd& G, const Eigen::VectorXd& q, Eigen::VectorXd& x) {
  const Eigen::Index n = G.rows();
  std::vector<Eigen::Index> free;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (x(i) > 0.0) free.push_back(i);
  }
  const double tolerance = 1e-12 * q.cwiseAbs().maxCoeff();
  descend(G, q, free, x);
  for (Eigen::Index round = 0; round < 10 * n + 100; ++round) {
    const Eigen::VectorXd descent = q - G * x;
    std::vector<Eigen::Index> entering;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (x(i) <= 0.0 && descent(i) > tolerance) entering.push_back(i);
    }
    bool entered = enter(G, q, entering, free);
    std::sort(entering.begin(), entering.end(), [&](Eigen::Index a, Eigen::Index b) {
      return descent(a) != descent(b) ? descent(a) > descent(b) : a < b;
    });
    for (std::size_t k = 0; !entered && k < entering.size(); ++k) entered = enter(G, q, {entering[k]}, free);
    if (!entered) return;
    descend(G, q, free, x);
  }
}

}  // namespace astrolith
