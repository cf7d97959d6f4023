// The layout of the PLY files that Astrolith writes.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "geometry/io/mesh_io.h"

namespace astrolith {

inline constexpr std::size_t kPlyTriangleBytes = 13;

// The header of a PLY file. It has the same length for all counts: a comment fills up what the digits leave.
struct PlyVertexParts {
  bool normals = false, colors = false, labels = false;
};
std::string ply_header(const MeshFileInfo& info, std::uint64_t num_vertices, std::uint64_t num_triangles,
                       const PlyVertexParts& parts);

// A triangle as one uchar, 3, and three little-endian uint32.
std::array<char, kPlyTriangleBytes> ply_triangle(const Triangle& triangle);

}  // namespace astrolith
