// How a mesh's triangles hang together, counted from the index arrays alone. Works on any input, also where
// no half-edge structure could hold it.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace astrolith {

struct MeshTopology {
  std::int64_t boundary_edges = 0;         // one triangle
  std::int64_t non_manifold_edges = 0;     // three or more triangles
  std::int64_t non_manifold_vertices = 0;  // triangles around it are not one disk or half disk
  std::int64_t misoriented_edges = 0;      // two or more triangles, not run through equally often both ways
  std::int64_t degenerate_triangles = 0;   // name a vertex twice; left out of every other count
  std::int64_t unused_vertices = 0;        // no triangle names them; left out of every other count
  std::int64_t components = 0;             // pieces that share no vertex
  std::int64_t euler_characteristic = 0;   // V - E + F
  std::int64_t genus = -1;  // summed over components; -1 where it has no meaning (open, non-manifold, ...)
  bool closed = false;      // triangles, and no boundary edges
  bool manifold = false;    // triangles, and no non-manifold edges or vertices; may be open
  bool oriented = false;    // no misoriented edges
};

// Indices must be below the number of vertices (InputError). Time O(F log F).
MeshTopology analyze_topology(const TriangleMesh& mesh);

// (#F) the component each triangle belongs to, numbered from 0 in the order of their first triangles.
// Indices must be in range.
std::vector<std::uint32_t> triangle_components(const TriangleMesh& mesh);

}  // namespace astrolith
