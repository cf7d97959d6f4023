// Tangents of a textured mesh, in which maps of normals are expressed.
#pragma once

#include <array>
#include <vector>

#include "geometry/atlas/texture_coordinates.h"

namespace astrolith {

// A unit tangent towards growing u, and the sign of the bitangent: bitangent = sign * cross(normal, tangent)
// points to the top of the image (glTF 2.0, TANGENT).
using VertexTangent = std::array<float, 4>;

// (#W) The tangents of MikkTSpace (Mikkelsen 2008), which glTF names and engines compute when a file has
// none: around a textured vertex, the derivatives of position by u of its triangles are projected into the
// plane of its normal, made unit and averaged with the angles of the triangles, projected too, as weights.
// The mesh must have normals. Where triangles are mirrored, each textured vertex must belong to triangles of
// one handedness.
std::vector<VertexTangent> vertex_tangents(const TriangleMesh& mesh, const TextureCoordinates& coordinates);

}  // namespace astrolith
