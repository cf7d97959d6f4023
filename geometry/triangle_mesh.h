// A triangle mesh as two plain arrays. Lengths are in whatever unit the file had; faces are counter-clockwise
// seen from outside, so that a closed mesh has positive volume.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "numerics/vec3.h"

namespace astrolith {

using Triangle = std::array<std::uint32_t, 3>;

// Red, green and blue of a vertex in sRGB (gamma-encoded).
using VertexColor = std::array<std::uint8_t, 3>;

struct TriangleMesh {
  std::vector<Vec3d> vertices;           // (#V) positions
  std::vector<Triangle> triangles;       // (#F) indices into vertices
  std::vector<Vec3d> normals;            // (#V) unit vertex normals, or empty
  std::vector<VertexColor> colors = {};  // (#V), or empty

  Box bounds() const {
    Box box;
    for (const Vec3d& p : vertices) box.extend(p);
    return box;
  }
};

}  // namespace astrolith
