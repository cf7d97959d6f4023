#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

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
  std::optional<std::size_t> owner;  // the solid that has this hollow
};

// The solid that a hollow lies in: the smallest that holds it. `parts` has the largest first. None where the
// hollow reaches out of all of them.
std::optional<std::size_t> find_owner(std::size_t hollow, const std::vector<SurfacePart>& parts,
                                      PartNesting& nesting) {
  for (std::size_t i = hollow; i-- > 0;) {
    if (parts[i].volume > 0.0 && nesting.lies_inside(parts[hollow], parts[i])) return i;
  }
  return {};
}

// All solids, the largest first. A cavity, whose volume is negative, is a hollow.
std::vector<Solid> find_solids(const TriangleMesh& mesh) {
  std::vector<SurfacePart> parts = split_parts(mesh, triangle_components(mesh));
  std::stable_sort(parts.begin(), parts.end(), [](const SurfacePart& a, const SurfacePart& b) {
    return std::abs(a.volume) > std::abs(b.volume);
  });
  PartNesting nesting;
  std::vector<Solid> solids;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    solids.push_back({exact_mesh(parts[i].mesh), parts[i].volume < 0.0, {}});
    if (!solids.back().hollow) continue;
    PMP::reverse_face_orientations(solids.back().mesh);
    solids.back().owner = find_owner(i, parts, nesting);
  }
  return solids;
}

// Adds a solid to a mesh, or takes a hollow away. Throws InputError for surfaces that touch or cross wrongly.
void combine(ExactMesh& mesh, Solid& solid, const std::string& failed) {
  const auto crossing = CGAL::parameters::throw_on_self_intersection(true);
  ExactMesh both;
  bool done = false;
  try {
    done = solid.hollow ? PMP::corefine_and_compute_difference(mesh, solid.mesh, both, crossing)
                        : PMP::corefine_and_compute_union(mesh, solid.mesh, both, crossing);
  } catch (const PMP::Corefinement::Self_intersection_exception&) {
    throw InputError(failed + ": one passes through itself");
  }
  if (!done) throw InputError(failed + ": some touch along edges or at vertices alone");
  mesh = std::move(both);
}

}  // namespace

TriangleMesh united(const TriangleMesh& mesh, const std::string& name, const Progress& progress) {
  const std::string failed = "its parts cannot be united";
  return guarded(name, failed, [&] {
    std::vector<Solid> solids = find_solids(mesh);
    // A cavity is cut out of its own solid. Another solid may fill it.
    for (Solid& solid : solids) {
      if (solid.owner) combine(solids[*solid.owner].mesh, solid, name + ": " + failed);
    }
    ExactMesh all = std::move(solids.front().mesh);
    for (std::size_t i = 1; i < solids.size(); ++i) {
      if (!report(progress, static_cast<double>(i) / static_cast<double>(solids.size()), "union")) {
        throw WorkError("stopped while parts of the mesh were united");
      }
      if (!solids[i].owner) combine(all, solids[i], name + ": " + failed);
    }
    return rounded_mesh(all);
  });
}

}  // namespace astrolith
