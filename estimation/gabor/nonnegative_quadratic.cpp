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

}  // namespace

void minimize_nonnegative_quadratic(const Eigen::MatrixXd& G, const Eigen::VectorXd& q, Eigen::VectorXd& x) {
  const Eigen::Index n = G.rows();
  std::vector<Eigen::Index> free;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (x(i) > 0.0) free.push_back(i);
  }
  std::vector<bool> refused(static_cast<std::size_t>(n), false);  // entered and left at once: rounding
  const double tolerance = 1e-12 * q.cwiseAbs().maxCoeff();
  for (Eigen::Index round = 0; round < 10 * n + 100; ++round) {
    while (!free.empty()) {
      const Eigen::VectorXd z = solve_free_block(G, q, free);
      if (z.minCoeff() > 0.0) {
        for (std::size_t k = 0; k < free.size(); ++k) x(free[k]) = z(static_cast<Eigen::Index>(k));
        break;
      }
      step_to_boundary(z, free, x);
    }
    const Eigen::VectorXd descent = q - G * x;
    Eigen::Index entering = -1;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (x(i) > 0.0 || refused[static_cast<std::size_t>(i)] || descent(i) <= tolerance) continue;
      if (entering < 0 || descent(i) > descent(entering)) entering = i;
    }
    if (entering < 0) return;
    // An entering coordinate that does not grow would be dropped and chosen again for ever.
    refused[static_cast<std::size_t>(entering)] = true;
    free.push_back(entering);
    x(entering) = 0.0;
    const Eigen::VectorXd z = solve_free_block(G, q, free);
    if (z(z.size() - 1) <= 0.0) {
      free.pop_back();
      continue;
    }
    std::fill(refused.begin(), refused.end(), false);
    // A coordinate entering at zero gives a step of length zero; any tiny positive start avoids it.
    x(entering) = 1e-300;
  }
}

}  // namespace astrolith
