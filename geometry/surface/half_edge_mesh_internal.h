// Half-edges (OpenMesh) of any triangle mesh, which is cut open wherever it is not an oriented manifold.
#pragma once

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <cstdint>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace astrolith {

struct HalfEdgeTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};
using HalfEdges = OpenMesh::TriMesh_ArrayKernelT<HalfEdgeTraits>;

struct HalfEdgeMesh {
  HalfEdges half_edges;
  // The vertex of the triangle mesh that each half-edge vertex comes from.
  std::vector<std::uint32_t> original;
  // (#V) how many half-edge vertices were made from each vertex: 1 where nothing was cut.
  std::vector<std::uint32_t> copies;
};

// Triangles stay joined across edges that exactly two of them share in opposite directions. Each fan of
// triangles joined so around a vertex gets a vertex of its own. Triangles that name a vertex twice are left
// out. Throws InputError for indices out of range.
HalfEdgeMesh half_edge_mesh(const TriangleMesh& mesh);

}  // namespace astrolith
