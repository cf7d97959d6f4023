#include "tests/benchmarks/decimated_mesh.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>

namespace astrolith {
namespace {

struct Traits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};
using HalfEdges = OpenMesh::TriMesh_ArrayKernelT<Traits>;

}  // namespace

TriangleMesh decimated(const TriangleMesh& mesh, std::size_t vertices) {
  HalfEdges half_edges;
  half_edges.request_face_normals();
  std::vector<HalfEdges::VertexHandle> handles;
  for (const Vec3d& p : mesh.vertices) handles.push_back(half_edges.add_vertex({p.x, p.y, p.z}));
  for (const Triangle& t : mesh.triangles) half_edges.add_face(handles[t[0]], handles[t[1]], handles[t[2]]);
  half_edges.update_face_normals();

  OpenMesh::Decimater::DecimaterT<HalfEdges> decimater(half_edges);
  OpenMesh::Decimater::ModQuadricT<HalfEdges>::Handle quadric;
  decimater.add(quadric);
  decimater.module(quadric).unset_max_err();
  decimater.initialize();
  decimater.decimate_to(vertices);
  half_edges.garbage_collection();

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
