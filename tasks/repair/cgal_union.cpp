#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "geometry/mesh_parts.h"
#include "geometry/mesh_topology.h"
#include "numerics/errors.h"
#include "tasks/repair/cgal_guard_internal.h"
#include "tasks/repair/cgal_repair_internal.h"

namespace astrolith {
namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
// Exact coordinates: a boolean operation on rounded ones may fail after another one.
using ExactKernel = CGAL::Exact_predicates_exact_constructions_kernel;
using ExactMesh = CGAL::Surface_mesh<ExactKernel::Point_3>;

ExactMesh exact_mesh(const TriangleMesh& mesh) {
  std::vector<ExactKernel::Point_3> points;
  std::vector<std::array<std::size_t, 3>> soup;
  for (const Vec3d& p : mesh.vertices) points.emplace_back(p.x, p.y, p.z);
  for (const auto& [a, b, c] : mesh.triangles) soup.push_back({a, b, c});
  ExactMesh exact;
  PMP::polygon_soup_to_polygon_mesh(points, soup, exact);
  return exact;
}

TriangleMesh rounded_mesh(const ExactMesh& exact) {
  TriangleMesh mesh;
  std::vector<std::uint32_t> number(exact.num_vertices() + exact.number_of_removed_vertices());
  for (const auto v : exact.vertices()) {
    number[static_cast<std::size_t>(v)] = static_cast<std::uint32_t>(mesh.vertices.size());
    const auto& p = exact.point(v);
    // The numbers are intervals until they are asked for exactly.
    mesh.vertices.push_back({CGAL::to_double(CGAL::exact(p.x())), CGAL::to_double(CGAL::exact(p.y())),
                             CGAL::to_double(CGAL::exact(p.z()))});
  }
  for (const auto f : exact.faces()) {
    Triangle t{};
    std::size_t k = 0;
    for (const auto v : CGAL::vertices_around_face(exact.halfedge(f), exact)) {
      if (k < 3) t[k++] = number[static_cast<std::size_t>(v)];
    }
    mesh.triangles.push_back(t);
  }
  return mesh;
}

struct Solid {
  ExactMesh mesh;  // wound outwards
  bool hollow = false;
  double volume = 0.0;  // > 0
};

// All solids, the largest first. A cavity, whose volume is negative, is a hollow.
std::vector<Solid> solids_of(const TriangleMesh& mesh) {
  std::vector<Solid> solids;
  for (const MeshPart& part : parts_of(mesh, triangle_components(mesh))) {
    solids.push_back({exact_mesh(part.mesh), part.volume < 0.0, std::abs(part.volume)});
    if (solids.back().hollow) PMP::reverse_face_orientations(solids.back().mesh);
  }
  std::stable_sort(solids.begin(), solids.end(),
                   [](const Solid& a, const Solid& b) { return a.volume > b.volume; });
  return solids;
}

}  // namespace

TriangleMesh united(const TriangleMesh& mesh, const std::string& name, const Progress& progress) {
  const std::string failed = "its parts cannot be united";
  return guarded(name, failed, [&] {
    std::vector<Solid> solids = solids_of(mesh);
    ExactMesh all = std::move(solids.front().mesh);
    const auto crossing = CGAL::parameters::throw_on_self_intersection(true);
    // A smaller solid may fill what a larger hollow left, never the other way.
    for (std::size_t i = 1; i < solids.size(); ++i) {
      if (!report(progress, static_cast<double>(i) / static_cast<double>(solids.size()), "union")) {
        throw WorkError("stopped while parts of the mesh were united");
      }
      ExactMesh both;
      bool done = false;
      try {
        done = solids[i].hollow ? PMP::corefine_and_compute_difference(all, solids[i].mesh, both, crossing)
                                : PMP::corefine_and_compute_union(all, solids[i].mesh, both, crossing);
      } catch (const PMP::Corefinement::Self_intersection_exception&) {
        throw InputError(name + ": " + failed + ": one passes through itself");
      }
      if (!done) throw InputError(name + ": " + failed + ": some touch along edges or at vertices alone");
      all = std::move(both);
    }
    return rounded_mesh(all);
  });
}

}  // namespace astrolith
