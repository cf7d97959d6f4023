// Solves small dense convex problems over the positive orthant.
#pragma once

#include <Eigen/Core>
#include <limits>

#include "numerics/progress.h"

namespace astrolith {

// Minimises 1/2 x'Gx - q'x over x >= 0 with an active-set method (Lawson and Hanson 1974). Many coordinates
// enter and leave at once while this lowers the value. G: n x n, symmetric, positive semidefinite with a
// positive diagonal. x: n values, >= 0, the start on entry and the solution on return. The method takes at
// most max_solves factorisations, and none after progress asks to stop; the value never rises. Returns
// whether x is the minimum.
bool minimize_nonnegative_quadratic(const Eigen::MatrixXd& G, const Eigen::VectorXd& q, Eigen::VectorXd& x,
                                    int max_solves = std::numeric_limits<int>::max(),
                                    const Progress& progress = {});

}  // namespace astrolith
