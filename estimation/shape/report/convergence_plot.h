// A curve of how a fit converged, as a picture.
#pragma once

#include <span>

#include "estimation/shape/fit/adaptive_fit.h"
#include "synthesis/picture/image_file.h"

namespace astrolith {

// Mean distance in % of the diagonal, logarithmic, against iterations of the refinement; every point is
// labelled with its number of spheres. `points` is not empty.
RgbImage plot_convergence(std::span<const ConvergencePoint> points);

}  // namespace astrolith
