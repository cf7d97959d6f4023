// Maps of a whole body by longitude and latitude: where a map shows a direction from the origin, and back.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "numerics/vec3.h"

namespace astrolith {

// kEquirectangular: longitude to the right and latitude up, in equal steps of degrees. kHemisphere: the
// azimuthal projection of Lambert, which keeps areas, of the half about its middle.
enum class MapProjection { kNone, kEquirectangular, kHemisphere };

// A map spans -1 .. 1 upwards, and -2 .. 2 (kEquirectangular) or -1 .. 1 (kHemisphere) to the right.
double map_width(MapProjection projection);

// The unit vector from the origin that a map shows at a place, as its parts towards the middle of the map, to
// the right and up there; none beside the map.
std::optional<Vec3d> map_direction(MapProjection projection, double x, double y);

// Where a map shows a direction with these parts, of any length above 0; none on the other hemisphere.
std::optional<std::pair<double, double>> map_place(MapProjection projection, const Vec3d& direction);

}  // namespace astrolith
