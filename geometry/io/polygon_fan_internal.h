// Splits polygons into fans of triangles around their first corner. This is exact for convex polygons, which
// are what shape models have.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace astrolith {

// Vertex indices have 32 bits, in TriangleMesh and in every binary format.
inline constexpr std::int64_t kMaxVertices = std::int64_t{0xffffffff};

inline void append_fan(std::span<const std::uint32_t> polygon, std::vector<Triangle>& triangles) {
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    triangles.push_back({polygon[0], polygon[i - 1], polygon[i]});
  }
}

}  // namespace astrolith
