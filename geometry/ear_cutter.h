// Cuts polygons that need not be convex into triangles, by ears.
//
// The libraries of Debian 12 do not serve: CGAL's triangulations are under the GPL, which synth is free of,
// and GLU's tessellator makes a vertex where a polygon crosses itself, 248 MB and 14 s for 2,000 random
// corners.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace astrolith {

// Readers refuse files with more: the sum of the squares of the corners of polygons that are not convex. The
// time grows with it, to some 3 s.
inline constexpr std::size_t kMostSquaredCorners = 1'000'000'000;

// Whether the triangles of a fan around the first corner lie side by side, seen along the polygon's normal
// (Newell's). True for convex polygons, for corners along one line, and for polygons without an area. `fan`
// has the triangles, one after another, and indices in range.
bool fan_covers_polygon(std::span<const Triangle> fan, const std::vector<Vec3d>& vertices);

// Replaces the fan by as many other triangles of the same corners that cover the polygon, seen along its
// normal. A corner at the place of another is allowed, as where a cut leads to a hole. The part of a polygon
// that crosses itself and leaves no ear remains a fan.
void cut_ears(std::span<Triangle> fan, const std::vector<Vec3d>& vertices);

}  // namespace astrolith
