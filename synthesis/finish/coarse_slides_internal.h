// Slides of loose ground over far distances, on clusters of columns instead of on the columns themselves.
//
// A slope of n columns takes about n^2 sweeps to settle, because a sweep moves ground by about one column.
// Clusters are some times wider than columns, so that their slope settles in fewer sweeps, each of fewer
// edges. Clusters of clusters go on until few are left. The coarsest ones slide first, and each level begins
// with what the coarser one has moved. What is left to a level is local: it takes a number of sweeps that
// hardly grows with the mesh.
#pragma once

#include <functional>
#include <vector>

#include "synthesis/finish/ground_slides_internal.h"

namespace astrolith {

// Returns the rise of each column that the slides of all coarser levels give, length units. `slope` is what
// slides on the columns aim at, a tangent. A sweep over n clusters moves ground as far as N / n sweeps over N
// columns do, so that a level makes at most most_sweeps n / N sweeps. All rises are 0 where that is less than
// one. They keep the volume but for a few hundredths of what moves. after_sweep() may throw, which ends the
// slides.
std::vector<double> coarse_slides(const Ground& ground, double slope, double most_sweeps,
                                  const std::function<void(int)>& after_sweep);

}  // namespace astrolith
