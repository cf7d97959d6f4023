// The bodies of a scene: closed components that neither overlap nor lie inside one another.
#pragma once

#include <cstdint>

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
SceneBodies bodies_of_scene(TriangleMesh mesh);

}  // namespace astrolith
