// Unit normals of triangles and vertices, pointing out of a mesh whose faces are counter-clockwise from
// outside.
#pragma once

#include <vector>

#include "geometry/triangle_mesh.h"

namespace astrolith {

// Zero for a triangle without area.
Vec3d triangle_normal(const TriangleMesh& mesh, const Triangle& triangle);

// (#F) unit normals.
std::vector<Vec3d> triangle_normals(const TriangleMesh& mesh);

// (#V) triangle normals averaged with the angle at the vertex as weight, which does not depend on how the
// surface is cut into triangles; zero where there is nothing to average. These are also the pseudo-normals
// that decide inside and outside (Baerentzen and Aanaes, "Signed distance computation using the angle
// weighted pseudonormal", IEEE TVCG 2005).
std::vector<Vec3d> vertex_normals(const TriangleMesh& mesh);

}  // namespace astrolith
