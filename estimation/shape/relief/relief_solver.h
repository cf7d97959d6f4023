// The heights that fit samples of a surface best.
#pragma once

#include <vector>

#include "estimation/shape/relief/relief_blend.h"
#include "numerics/progress.h"

namespace astrolith {

// One height for each place, length units: the least squares of
//   sum_i (sum_k share_ik h_k - height_i)^2 + kPull d sum_k (h_k - m_k)^2
// by conjugate gradients, where m_k is the mean of the samples around the place weighted by their shares, and
// d the mean over the places of the sum of the squares of their shares. A place that hardly any sample sees,
// as at the border of a map, so keeps that mean. Places without samples get 0. `progress` may end the
// iteration early.
std::vector<double> solve_relief(const ReliefBlend& blend, const Progress& progress);

}  // namespace astrolith
