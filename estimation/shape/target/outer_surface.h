// The outer surface of a mesh whose components overlap, as the lobes of a contact binary do: the surface of
// their union. Walls that are buried in another component bound nothing, and no fit can follow them.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/surface/surface_tree.h"
#include "geometry/triangle_mesh.h"

namespace astrolith {

struct OuterSurface {
  TriangleMesh mesh;            // without the buried triangles; open along the seam where components meet
  std::int64_t components = 1;  // number of components of the union
  // (#F of the whole mesh) the union's component that each triangle belongs to, 0 .. components - 1
  std::vector<std::uint32_t> component_of_triangle;
};

// `mesh` is closed and oriented, and `tree` was made of it. A triangle is buried if its centroid lies deeper
// than `depth` inside the union; `depth` is in the mesh's unit. The mesh comes back unchanged if it has one
// component, more than 64 components, or cavities.
OuterSurface outer_surface(const TriangleMesh& mesh, const SurfaceTree& tree, double depth);

}  // namespace astrolith
