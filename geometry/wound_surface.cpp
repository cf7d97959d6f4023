#include "geometry/wound_surface.h"

#include <utility>

#include "geometry/mesh_measure.h"
#include "geometry/mesh_topology.h"
#include "geometry/orient_faces.h"
#include "geometry/weld.h"

namespace astrolith {
namespace {

bool wound_alike(const Triangle& a, const Triangle& b) {
  return (a[0] == b[0] && a[1] == b[1]) || (a[1] == b[0] && a[2] == b[1]) || (a[2] == b[0] && a[0] == b[1]);
}

}  // namespace

std::string WoundSurface::words() const {
  std::string text;
  if (merged_vertices > 0) text = "merged " + std::to_string(merged_vertices) + " vertices at equal places";
  if (turned_faces == 0) return text;
  if (!text.empty()) text += ", ";
  return text + "turned " + std::to_string(turned_faces) + (turned_faces == 1 ? " facet" : " facets");
}

bool is_closed_body(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return false;
  const MeshTopology topology = analyze_topology(mesh);
  const bool sound = topology.closed && topology.non_manifold_edges == 0 && topology.oriented;
  if (!sound || !(volume(mesh) > 0.0)) return false;
  return topology.components == 1 || orient_faces(mesh).triangles == mesh.triangles;
}

std::int64_t count_turned(const TriangleMesh& before, const TriangleMesh& after) {
  std::int64_t turned = 0;
  for (std::size_t f = 0; f < before.triangles.size(); ++f) {
    turned += wound_alike(before.triangles[f], after.triangles[f]) ? 0 : 1;
  }
  return turned;
}

WoundSurface wound_surface(TriangleMesh mesh) {
  WoundSurface wound;
  if (mesh.triangles.empty() || is_closed_body(mesh)) {
    wound.mesh = std::move(mesh);
    return wound;
  }
  if (const std::int64_t open = analyze_topology(mesh).boundary_edges; open > 0) {
    TriangleMesh welded =
        without_unused_vertices(drop_degenerate_and_repeated_faces(weld_vertices(mesh, 0.0)));
    if (analyze_topology(welded).boundary_edges < open) {
      wound.merged_vertices = static_cast<std::int64_t>(mesh.vertices.size() - welded.vertices.size());
      mesh = std::move(welded);
      mesh.normals.clear();
      mesh.colors.clear();
    }
  }
  wound.mesh = orient_faces(mesh);
  wound.turned_faces = count_turned(mesh, wound.mesh);
  if (wound.turned_faces > 0) wound.mesh.normals.clear();
  return wound;
}

}  // namespace astrolith
