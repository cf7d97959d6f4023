// A closed mesh of few facets that follows another one: vertices in one cell of a lattice become one.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace astrolith {

struct CoarseSurface {
  TriangleMesh mesh;                // a vertex is the mean of the vertices in its cell; no normals
  std::vector<std::uint32_t> cell;  // for each vertex of the fine mesh, its vertex here
};

// The lattice has `cells` >= 1 cells along the longest side of the mesh's box. Facets whose corners lie in
// fewer than three cells vanish. The coarse mesh of a closed mesh is closed, and encloses about the same
// volume as long as the body is wider than a few cells; it may touch itself.
CoarseSurface coarse_surface(const TriangleMesh& mesh, int cells);

}  // namespace astrolith
