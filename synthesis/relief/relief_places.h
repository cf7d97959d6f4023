// The places at which a relief layer stores its heights. They follow from the bare body and a spacing alone,
// so that whoever reads a recipe finds them again.
//
// A cubic lattice with the spacing covers space. A place is a point where a line of the lattice, parallel to
// the axis a, crosses the bare surface with |n_a| > sqrt(kLeastReliefSlant), n the normal there. The places
// of one axis are a height map of the surface seen along that axis. Every point of the surface has an axis
// with n_a^2 >= 1/3, and the maps of several axes overlap where the surface is oblique to them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "synthesis/body/body_ground.h"

namespace astrolith {

inline constexpr float kLeastReliefSlant = 0.2f;  // of n_a^2
// At most so many places serve one layer: a relief of 16 million heights.
inline constexpr std::size_t kMostReliefPlaces = std::size_t{1} << 24;

// Lengths in units of the spacing.
struct ReliefPlace {
  std::int32_t axis;     // 0, 1 or 2: x, y or z; u and v are the next two axes in turn
  std::int32_t u, v;     // numbers of the line of the lattice
  float w;               // coordinate along the axis
  Vec3f normal;          // outwards, unit length, its components along the axis, u and v
  std::uint16_t weight;  // of the place's height in the blend of the maps, 1 .. 65535
};

// The places of a body for a spacing in length units, by axis, v, u and w. Expects coordinates of the body's
// frame: ground.origin is not read. Throws InputError, which begins with `where`, where the spacing is so
// small that there would be more than kMostReliefPlaces.
std::vector<ReliefPlace> find_relief_places(const BodyGround& ground, double spacing,
                                            const std::string& where);

}  // namespace astrolith
