// The surface of the union where a mesh's parts reach into one another, as the lobes of a contact binary do:
// walls buried in another part bound nothing, and no fit can follow them.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/surface/surface_tree.h"
#include "geometry/triangle_mesh.h"

namespace astrolith {

struct OuterSurface {
  TriangleMesh mesh;       // without the buried triangles; open along the seam where parts meet
  std::int64_t parts = 1;  // of the union
  // (#F of the whole mesh) which of them, 0 .. parts - 1.
  std::vector<std::uint32_t> part_of_triangle;
};

// `mesh` is closed and oriented, `tree` was made of it. Triangles whose centroid lies deeper than `depth`
// inside the union are buried. Meshes of one part, with cavities or of more than 64 parts come back as they
// are.
OuterSurface outer_surface(const TriangleMesh& mesh, const SurfaceTree& tree, double depth);

}  // namespace astrolith
