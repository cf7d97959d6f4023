#include "geometry/surface/decimated_mesh.h"

#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "geometry/mesh_edges.h"
#include "geometry/mesh_measure.h"
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

TriangleMesh clustered(const TriangleMesh& mesh, std::size_t vertices) {
  if (mesh.vertices.size() <= vertices) return mesh;
  // A surface passes through some two cells for each square of its area.
  const double side = std::sqrt(2.0 * surface_area(mesh) / static_cast<double>(vertices));
  const Vec3d corner = mesh.bounds().min;
  using Cell = std::array<std::int64_t, 3>;
  std::vector<std::pair<Cell, std::uint32_t>> cells(mesh.vertices.size());
  for (std::uint32_t v = 0; v < cells.size(); ++v) {
    const Vec3d at = (1.0 / side) * (mesh.vertices[v] - corner);
    cells[v] = {{std::llround(at.x), std::llround(at.y), std::llround(at.z)}, v};
  }
  std::sort(cells.begin(), cells.end());
  TriangleMesh result;
  std::vector<std::uint32_t> merged(cells.size());
  for (std::size_t first = 0, end = 0; first < cells.size(); first = end) {
    Vec3d sum{};
    for (; end < cells.size() && cells[end].first == cells[first].first; ++end) {
      sum = sum + mesh.vertices[cells[end].second];
      merged[cells[end].second] = static_cast<std::uint32_t>(result.vertices.size());
    }
    result.vertices.push_back(sum * (1.0 / static_cast<double>(end - first)));
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    const Triangle t{merged[a], merged[b], merged[c]};
    if (!is_degenerate(t)) result.triangles.push_back(t);
  }
  return result;
}

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
