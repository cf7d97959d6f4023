// The plots of a fit's report.
#pragma once

#include <filesystem>
#include <span>

#include "estimation/shape/fit/adaptive_fit.h"

namespace astrolith {

// Writes a PNG of the mean distance against the iterations of the refinement. The distance is a percentage of
// the diagonal of the bounding box, on a logarithmic axis. Where the number of metaballs changes, the point
// is labelled with the new number. `points` is not empty. Throws InputError where the file cannot be written.
void write_convergence_plot(std::span<const ConvergencePoint> points, const std::filesystem::path& file);

// Writes a PNG with a histogram of `distances`: signed fractions of the diagonal of the bounding box, at
// points spread evenly over the fit, positive where the fit lies inside the target. The histogram reaches
// from -limit to limit (> 0); its outer bars also count all distances beyond. Throws InputError where the
// file cannot be written.
void write_error_histogram(std::span<const double> distances, double limit,
                           const std::filesystem::path& file);

}  // namespace astrolith
