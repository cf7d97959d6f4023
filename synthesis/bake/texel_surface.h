// Carries points of a coarse mesh along their normals to the surface of the field.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "numerics/vec3.h"
#include "synthesis/field/implicit_field.h"

namespace astrolith {

struct SurfacePoint {
  Vec3f start, along;     // the place on the coarse mesh, and its unit normal
  float height = 0.0f;    // the surface lies at start + height * along, length units
  Vec3f normal;           // of the surface there, unit length, outwards
  bool is_found = false;  // whether F = 0 was met; if not, the place with the least |F| that was tried

  Vec3f place() const { return start + along * height; }
};

// Texels of a tile, row-major, each with the number of its point, or -1.
struct TexelGrid {
  std::span<const std::int16_t> number;
  int width;
};

// Finds the surface from the points of a grid, at most TexelTile::kMostTexels. From every second point of
// every second row: F at the start is about the distance, and steps of the secant follow until |F| is below a
// quarter of `texel` (length units). The other points begin at the mean height of their neighbours among
// those, and are sought in the same way only where that is more than half a texel from the surface.
//
// The normal is the gradient of F over a tetrahedron that reaches a quarter of a texel along each axis,
// evaluated as the mesher does. The height takes a last step of Newton's along it.
void find_surface(const ImplicitField& field, float texel, const TexelGrid& grid,
                  std::span<SurfacePoint> points);

}  // namespace astrolith
