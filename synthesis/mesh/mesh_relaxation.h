// Moves the vertices of a mesh along its surface, so that its triangles become more even. Triangles keep
// their vertices.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/mesh_sink.h"

namespace astrolith {

// Places of all vertices after some sweeps. A sweep moves each vertex to the mean of its neighbours, within
// the plane through the vertex that its normal is perpendicular to. All vertices of a sweep move at once, so
// that the result depends on the mesh alone. Vertices at open edges stay where they are. The mesh must be
// manifold and its indices in range.
std::vector<Vec3f> relaxed_places(std::span<const MeshVertex> vertices, std::span<const Triangle> triangles,
                                  int sweeps);

// Whether a triangle faces into the body, as the normals of its corners say.
bool is_turned_over(const MeshVertex& a, const MeshVertex& b, const MeshVertex& c);

// Puts vertices of `moved` back as they are in `plain`, until each triangle that is turned over has all its
// corners there. Such a triangle is turned over in the plain mesh already.
void put_back_turned(std::span<const MeshVertex> plain, std::span<const Triangle> triangles,
                     std::span<MeshVertex> moved);

}  // namespace astrolith
