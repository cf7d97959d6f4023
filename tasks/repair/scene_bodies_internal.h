// The bodies of a scene: closed components that neither overlap nor lie inside one another.
#pragma once

#include <cstdint>

#include "geometry/triangle_mesh.h"

namespace astrolith {

struct LargestBody {
  TriangleMesh mesh;
  std::int64_t bodies = 1;
  double volume_share = 1.0;  // of the largest body in the volume of all
};

// The body of greatest volume, with its cavities and with the lobes that overlap it. A mesh of one body comes
// back as it is. The mesh is closed and wound alike. Beyond 64 components the smaller ones count for bodies
// of their own, unless their boxes touch that of a greater one.
LargestBody largest_body(TriangleMesh mesh);

}  // namespace astrolith
