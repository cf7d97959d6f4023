// Texture coordinates by longitude and latitude, for maps of whole bodies.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace astrolith {

// A mesh whose vertices have texture coordinates. A triangle that crosses the 180th meridian would run
// backwards over the whole map. Its western vertices are therefore there twice: the second has u + 1, and
// maps repeat in u.
struct LongitudeLatitude {
  std::vector<std::uint32_t> doubled;  // (d) the vertices that are there twice, in the order of their seconds
  std::vector<std::array<float, 2>>
      texcoords;                    // (#V + d) u = 1/2 + longitude / 360 deg, v = 1/2 - latitude / 180 deg
  std::vector<Triangle> triangles;  // (#F) index #V + k is the second of doubled[k]
};

// Longitudes run east from +x about z, latitudes from the xy plane towards +z, both seen from the origin of
// the frame, which lies at -`origin` in the mesh's coordinates. The triangles at the two poles are distorted,
// as in every such map.
LongitudeLatitude longitude_latitude(const TriangleMesh& mesh, const Vec3d& origin);

}  // namespace astrolith
