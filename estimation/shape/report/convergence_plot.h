// A plot of how a fit converged.
#pragma once

#include <filesystem>
#include <span>

#include "estimation/shape/fit/adaptive_fit.h"

namespace astrolith {

// Writes a PNG of the mean distance against the iterations of the refinement. The distance is a percentage of
// the diagonal of the bounding box, on a logarithmic axis. Where the number of metaballs changes, the point
// is labelled with the new number. `points` is not empty. Throws InputError where the file cannot be written.
void write_convergence_plot(std::span<const ConvergencePoint> points, const std::filesystem::path& file);

}  // namespace astrolith
