// Where a straight line crosses the surface of a field.
#pragma once

#include <optional>

#include "synthesis/field/implicit_field.h"

namespace astrolith {

// The crossing of the line from + t direction, |t| <= reach, that lies nearest to t = 0, to reach / 2^18.
// `direction` has unit length, reach > 0 is a length. None where no two of 65 points along the line lie on
// different sides: crossings nearer to each other than reach / 32 can be missed.
std::optional<Vec3d> nearest_crossing(const ImplicitField& field, const Vec3d& from, const Vec3d& direction,
                                      double reach);

}  // namespace astrolith
