#include "geometry/surface/decimated_mesh.h"

#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>

#include "geometry/surface/half_edge_mesh_internal.h"

namespace astrolith {
namespace {

void collapse_edges(HalfEdges& half_edges, std::size_t vertices) {
  half_edges.request_face_normals();
  half_edges.update_face_normals();
  OpenMesh::Decimater::DecimaterT<HalfEdges> decimater(half_edges);
  OpenMesh::Decimater::ModQuadricT<HalfEdges>::Handle quadric;
  decimater.add(quadric);
  decimater.module(quadric).unset_max_err();
  decimater.initialize();
  decimater.decimate_to(vertices);
  half_edges.garbage_collection();
}

}  // namespace

TriangleMesh decimated(const TriangleMesh& mesh, std::size_t vertices) {
  HalfEdges half_edges = half_edge_mesh(mesh).half_edges;
  collapse_edges(half_edges, vertices);
  TriangleMesh result;
  for (const auto v : half_edges.vertices()) {
    const auto& p = half_edges.point(v);
    result.vertices.push_back({p[0], p[1], p[2]});
  }
  for (const auto f : half_edges.faces()) {
    Triangle t{};
    std::size_t k = 0;
    for (auto v = half_edges.cfv_iter(f); v.is_valid(); ++v) t[k++] = static_cast<std::uint32_t>(v->idx());
    result.triangles.push_back(t);
  }
  return result;
}

}  // namespace astrolith
