// Small dense quadratic programs with non-negative unknowns.
#pragma once

#include <Eigen/Core>

namespace astrolith {

// Minimises 1/2 x'G x - q'x over x >= 0 by the active-set method of Lawson and Hanson (1974, chapter 23) with
// a Cholesky factorisation of the free block. G: n x n, symmetric, positive semidefinite, positive diagonal.
// x holds a first guess >= 0 and receives the minimiser.
void minimize_nonnegative_quadratic(const Eigen::MatrixXd& G, const Eigen::VectorXd& q, Eigen::VectorXd& x);

}  // namespace astrolith
