// The texture coordinates of a mesh. A vertex at the border of a chart has several of them: the mesh stays as
// it is, and a list of textured vertices says which vertex each of them is.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace astrolith {

using TexturePoint = std::array<float, 2>;

struct TextureCoordinates {
  std::vector<std::uint32_t> vertex_of;  // (#W) the vertex of the mesh that each textured vertex is
  // (#W) u and v in [0, 1]: u from the left of the image to the right, v from the top down (glTF 2.0).
  std::vector<TexturePoint> uv;
  std::vector<Triangle> triangles;  // (#F) textured vertices, corner by corner those of the mesh's triangles
};

}  // namespace astrolith
