// What the spots of given impulses can sum up to anywhere in a box.
#pragma once

#include <span>

#include "numerics/vec3.h"
#include "synthesis/noise_octaves.h"
#include "synthesis/spot_kernel.h"

namespace astrolith {

// Relative, for the rounding of positions and kernels.
inline constexpr double kSpotSlack = 1e-5;

// sum_l spot_height at every float point of the box, length units.
Interval bound_spots(const SpotKernel& kernel, std::span<const SpotImpulse> impulses, const Box& box);

}  // namespace astrolith
