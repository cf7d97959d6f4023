// How the distances between fit and target are spread, as a picture.
#pragma once

#include <span>

#include "synthesis/picture/image_file.h"

namespace astrolith {

// `distances`: signed, fractions of the diagonal, at points spread evenly over the fit; positive where the
// fit lies inside the target. Drawn from -limit to limit (> 0), with those beyond in the outer bars.
RgbImage plot_error_histogram(std::span<const double> distances, double limit);

}  // namespace astrolith
