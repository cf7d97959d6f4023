// The last step of a likeness: heights move by some hundredths of an edge, until small patches of the surface
// are distributed as those of the measured one. Patches that were laid lost the bends of the base that had
// belonged to them, and seams and gains their sharpest forms.
//
// First patches of 8 x 8 values, three edges, two and one apart in turn, move towards where a sliced
// transport (sliced_transport.h) puts them, a place by the mean of what the patches around it want. Then
// features of patches of 16 x 16 values (patch_features.h), new ones in each step, are moved in the same way
// by gradients with momentum.
#pragma once

#include <cstdint>
#include <vector>

#include "synthesis/relief/relief_smoothing.h"
#include "synthesis/relief/relief_values.h"

namespace astrolith {

// The values of a surface at points.
struct SurfaceValues {
  const ReliefPoints& points;
  const std::vector<double>& values;  // length units
};

// What is added to the coefficients of `blend` at the drawn points. `edge` is the mean edge of the measured
// model, length units. Nothing is added where a surface has room for too few patches.
std::vector<double> matched_change(const SurfaceValues& measured, const SurfaceValues& drawn,
                                   const ReliefValues& blend, double edge, std::uint32_t hash);

}  // namespace astrolith
