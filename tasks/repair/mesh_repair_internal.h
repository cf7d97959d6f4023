// Steps of a repair: fins and debris go, borders that lie along one another are joined, and the bodies of a
// scene are found.
#pragma once

#include <cstdint>
#include <string>

#include "geometry/triangle_mesh.h"

namespace astrolith {

struct SceneBodies {
  TriangleMesh largest;          // as it was given where there is one body
  std::int64_t bodies = 1;       // apart from one another
  double volume_share = 1.0;     // of the largest body in the volume of all
  std::int64_t overlapping = 0;  // components that reach into a larger one
  std::int64_t nested = 0;       // components in the rock of a larger one, wound as it is
  std::int64_t cavities = 0;     // components in the rock of a larger one, wound the other way
  std::int64_t undecided = 0;    // components of which finding this out would have taken too long
};

// The body of greatest volume, with its cavities and with the lobes that overlap it, and how the components
// lie to one another. The mesh is closed and wound alike. Beyond 64 components the smaller ones count for
// bodies of their own, unless their boxes touch that of a greater one.
SceneBodies find_bodies(TriangleMesh mesh);

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
