// The texture coordinates of a mesh. A vertex at the border of a chart has several of them: the mesh stays as
// it is, and a list of textured vertices says which vertex each of them is.
// Coordinates by longitude and latitude, and the tangents in which maps of normals are expressed.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace astrolith {

using TexturePoint = std::array<float, 2>;

struct TextureCoordinates {
  std::vector<std::uint32_t> mesh_vertex;  // (#W) the vertex of the mesh that each textured vertex is
  // (#W) u and v in [0, 1]: u from the left of the image to the right, v from the top down (glTF 2.0).
  std::vector<TexturePoint> uv;
  std::vector<Triangle> triangles;  // (#F) textured vertices, corner by corner those of the mesh's triangles
};

// A unit tangent towards growing u, and the sign of the bitangent: bitangent = sign * cross(normal, tangent)
// points to the top of the image (glTF 2.0, TANGENT).
using VertexTangent = std::array<float, 4>;

// (#W) The tangents of MikkTSpace (Mikkelsen 2008), which glTF names and engines compute when a file has
// none: around a textured vertex, the derivatives of position by u of its triangles are projected into the
// plane of its normal, made unit and averaged with the angles of the triangles, projected too, as weights.
// The mesh must have normals. Where triangles are mirrored, each textured vertex must belong to triangles of
// one handedness.
std::vector<VertexTangent> vertex_tangents(const TriangleMesh& mesh, const TextureCoordinates& coordinates);

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
