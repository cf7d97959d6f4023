// Topology of a mesh, counted from its index arrays alone. It works on any input, also where no half-edge
// structure could hold the mesh.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace astrolith {

struct MeshTopology {
  std::int64_t boundary_edges = 0;         // edges of one triangle
  std::int64_t non_manifold_edges = 0;     // edges of three or more triangles
  std::int64_t non_manifold_vertices = 0;  // vertices whose triangles are not one disk or half disk
  std::int64_t misoriented_edges = 0;      // edges not run through equally often both ways
  std::int64_t degenerate_triangles = 0;   // triangles that name a vertex twice; no other count has them
  std::int64_t unused_vertices = 0;        // vertices of no triangle; no other count has them
  std::int64_t components = 0;             // connected through shared vertices
  std::int64_t euler_characteristic = 0;   // V - E + F
  std::int64_t genus = -1;                 // sum over components; -1 unless closed, manifold and oriented
  bool closed = false;                     // has triangles and no boundary edges
  bool manifold = false;  // has triangles, and no non-manifold edges or vertices; may be open
  bool oriented = false;  // has no misoriented edges
};

// Counts everything above. Throws InputError for an index that is not below the number of vertices. Takes
// time O(F log F).
MeshTopology analyze_topology(const TriangleMesh& mesh);

// (#F) the component that each triangle belongs to, numbered from 0 in the order of the components' first
// triangles. Indices must be in range.
std::vector<std::uint32_t> triangle_components(const TriangleMesh& mesh);

}  // namespace astrolith
