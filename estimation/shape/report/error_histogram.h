// A plot of how the distances between fit and target are distributed.
#pragma once

#include <filesystem>
#include <span>

namespace astrolith {

// Writes a PNG with a histogram of `distances`: signed fractions of the diagonal of the bounding box, at
// points spread evenly over the fit, positive where the fit lies inside the target. The histogram reaches
// from -limit to limit (> 0); its outer bars also count all distances beyond. Throws InputError where the
// file cannot be written.
void write_error_histogram(std::span<const double> distances, double limit,
                           const std::filesystem::path& file);

}  // namespace astrolith
