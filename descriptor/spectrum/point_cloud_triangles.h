// Triangles between the points of a cloud, enough of them for a Laplacian though not a surface.
//
// Sharp and Crane, "A Laplacian for nonmanifold triangle meshes", SGP 2020, section 5.7: the neighbours of
// each point are laid into its tangent plane, and the triangles that meet at the point in their Delaunay
// triangulation are taken. Most triangles are found from each of their corners, so the whole covers the
// surface about three times.
#pragma once

#include <span>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace astrolith {

// Of each point and its `neighbours` nearest ones; 3 <= neighbours < n. normals (n) unit vectors. Throws
// InputError for other numbers.
std::vector<Triangle> point_cloud_triangles(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                                            int neighbours);

}  // namespace astrolith
