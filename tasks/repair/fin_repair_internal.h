// Fins and debris: patches of facets that are no part of a body's surface.
#pragma once

#include <cstdint>

#include "geometry/triangle_mesh.h"

namespace astrolith {

struct WithoutFins {
  TriangleMesh mesh;
  std::int64_t dropped_facets = 0;
  double dropped_area = 0.0;
};

// Drops patches that have a free border and hang on an edge of three or more facets, if each has at most 5 %
// of the area of all. A patch is what hangs together across edges of two facets.
WithoutFins without_fins(TriangleMesh mesh);

// Drops open pieces of at most 1 % of the area of all. A piece is what hangs together across edges.
WithoutFins without_debris(TriangleMesh mesh);

}  // namespace astrolith
