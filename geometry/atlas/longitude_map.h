// Texture coordinates by longitude and latitude.
#pragma once

#include "geometry/atlas/texture_coordinates.h"
#include "geometry/triangle_mesh.h"

namespace astrolith {

struct LongitudeMap {
  TriangleMesh mesh;  // cut along the 180th meridian and at the poles; closed where it was closed
  TextureCoordinates coordinates;  // of the cut mesh
};

// u = 1/2 + longitude / 360 degrees, v = 1/2 - latitude / 180 degrees. Longitudes run east from +x about z,
// latitudes from the xy plane towards +z, both seen from the origin of the frame, which lies at -`origin` in
// the mesh's coordinates. A triangle across the 180th meridian would run backwards over the whole map, so the
// meridian cuts such triangles. Vertices on it are there twice: with u = 0 and with u = 1. A vertex on the
// axis has the mean u of each triangle's other corners. Maps are distorted at the poles.
LongitudeMap longitude_map(const TriangleMesh& mesh, const Vec3d& origin);

}  // namespace astrolith
