// Joins borders that lie along one another: cracks, and vertices on the edge of another facet.
#pragma once

#include <cstdint>
#include <string>

#include "geometry/triangle_mesh.h"

namespace astrolith {

struct JoinedBorders {
  TriangleMesh mesh;
  std::int64_t joined_vertices = 0;
  std::int64_t split_facets = 0;
  double moved = 0.0;  // greatest distance that a vertex, or a facet's edge, went
};

// Joins border vertices that are nearer to each other than 0.45 of the shortest border edge at either, and
// splits facets at border vertices that lie on their border edge. Distances above 0.5 % of the diagonal are
// left alone. Throws InputError where borders crowd.
JoinedBorders join_borders(TriangleMesh mesh, const std::string& name);

}  // namespace astrolith
