// Carries points of a coarse mesh along their normals to the surface of the field.
#pragma once

#include <cstddef>
#include <span>

#include "numerics/vec3.h"
#include "synthesis/field/implicit_field.h"

namespace astrolith {

struct SurfacePoint {
  Vec3f start, along;      // the place on the coarse mesh, and its unit normal
  float height = 0.0f;     // the surface lies at start + height * along, length units
  Vec3f normal;            // of the surface there, unit length, outwards
  bool is_found = false;   // whether F = 0 was met; if not, the place with the least |F| that was tried

  Vec3f place() const { return start + along * height; }
};

// Finds the surface from each point's start: F there is about the distance, and steps of the secant follow
// until |F| is below a sixteenth of `texel` (length units). The normal is the gradient of F over a tetrahedron
// that reaches a quarter of a texel along each axis, evaluated as the mesher does. At most
// TexelTile::kMostTexels points, which lie near each other.
void find_surface(const ImplicitField& field, float texel, std::span<SurfacePoint> points);

}  // namespace astrolith
