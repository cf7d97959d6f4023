// Small dense convex problems over the positive orthant.
#pragma once

#include <Eigen/Core>
#include <limits>

namespace astrolith {

// Minimises 1/2 x'Gx - q'x over x >= 0 with an active-set method (Lawson and Hanson 1974), in which many
// coordinates enter and leave at once while that lowers the value. G: n x n, symmetric, positive semidefinite
// with a positive diagonal; x: n values, >= 0, the start on entry and the solution on return. Takes at most
// max_solves factorisations; the value never rises, whenever it stops. Returns whether x is the minimum.
bool minimize_nonnegative_quadratic(const Eigen::MatrixXd& G, const Eigen::VectorXd& q, Eigen::VectorXd& x,
                                    int max_solves = std::numeric_limits<int>::max());

}  // namespace astrolith
