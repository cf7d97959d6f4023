// Triangles between the points of a cloud: enough of them for a Laplacian, though they form no surface.
//
// Sharp and Crane, "A Laplacian for nonmanifold triangle meshes", SGP 2020, section 5.7. The neighbours of
// each point are projected into its tangent plane, and the triangles that meet at the point in their Delaunay
// triangulation are taken. Most triangles are found from each of their corners, so that all triangles
// together cover the surface about three times.
#pragma once

#include <span>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace astrolith {

// Triangles among each point and its `neighbours` nearest points. normals (n) are unit vectors. Throws
// InputError unless there is a normal for each point and 3 <= neighbours < n.
std::vector<Triangle> point_cloud_triangles(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                                            int neighbours);

}  // namespace astrolith
