// Unit normals of triangles and vertices, pointing out of a mesh whose faces are counter-clockwise from
// outside.
#pragma once

#include <vector>

#include "geometry/triangle_mesh.h"

namespace astrolith {

// The unit normal of a triangle; zero for a triangle without area.
Vec3d triangle_normal(const TriangleMesh& mesh, const Triangle& triangle);

// (#F) unit normals.
std::vector<Vec3d> triangle_normals(const TriangleMesh& mesh);

// (#V) unit normals: triangle normals averaged with the angle at the vertex as weight. The average does not
// depend on how the surface is cut into triangles. A vertex without triangles of an area has the normal zero.
// These are also the pseudo-normals that decide between inside and outside (Baerentzen and Aanaes, "Signed
// distance computation using the angle weighted pseudonormal", IEEE TVCG 2005).
std::vector<Vec3d> vertex_normals(const TriangleMesh& mesh);

}  // namespace astrolith
