#include "geometry/mesh_edges.h"
#include "geometry/surface/half_edge_mesh_internal.h"
#include "numerics/errors.h"

namespace astrolith {
namespace {

// Joins those of the 3 #F corners that belong to one fan of triangles around a vertex.
DisjointSets join_fans(const TriangleMesh& mesh) {
  DisjointSets fans(3 * mesh.triangles.size());
  for_each_edge(sorted_sides(mesh), [&](std::span<const TriangleSide> edge) {
    if (edge.size() != 2 || edge[0].forward == edge[1].forward) return;
    fans.unite(edge[0].low_corner(), edge[1].low_corner());
    fans.unite(edge[0].high_corner(), edge[1].high_corner());
  });
  return fans;
}

}  // namespace

HalfEdgeMesh half_edge_mesh(const TriangleMesh& mesh) {
  check_indices(mesh);
  HalfEdgeMesh result;
  result.copies.assign(mesh.vertices.size(), 0);
  DisjointSets fans = join_fans(mesh);
  std::vector<OpenMesh::VertexHandle> fan_vertex(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& triangle = mesh.triangles[t];
    if (is_degenerate(triangle)) continue;
    std::array<OpenMesh::VertexHandle, 3> corners;
    for (std::uint32_t k = 0; k < 3; ++k) {
      OpenMesh::VertexHandle& vertex = fan_vertex[fans.find(3 * t + k)];
      if (!vertex.is_valid()) {
        const Vec3d& p = mesh.vertices[triangle[k]];
        vertex = result.half_edges.add_vertex({p.x, p.y, p.z});
        result.original.push_back(triangle[k]);
        ++result.copies[triangle[k]];
      }
      corners[k] = vertex;
    }
    // This cannot fail on a mesh that has been cut open; OpenMesh would print the reason.
    if (!result.half_edges.add_face(corners[0], corners[1], corners[2]).is_valid()) {
      throw WorkError("mesh: half-edges cannot hold triangle " + std::to_string(t));
    }
  }
  return result;
}

}  // namespace astrolith
