#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_self_intersections.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <set>
#include <utility>

#include "numerics/errors.h"
#include "tasks/repair/cgal_guard_internal.h"
#include "tasks/repair/cgal_repair_internal.h"

namespace astrolith {
namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using SurfaceMesh = CGAL::Surface_mesh<Point>;
using HalfEdge = SurfaceMesh::Halfedge_index;
using Facet = SurfaceMesh::Face_index;
using Soup = std::vector<std::array<std::size_t, 3>>;

// A hole of n edges takes about n^3 / 6 steps of the search for its best facets, 2 microseconds each. Holes
// above this number of edges take the facets among those of a Delaunay triangulation of their border, and may
// fail.
constexpr std::size_t kMostCubicEdges = 300;
// All holes together: ten seconds. Holes of at most a dozen edges are not counted.
constexpr double kMostCubicSteps = 5e6;
constexpr std::size_t kUncountedEdges = 12;
// Holes of fewer edges are filled by facets between their border's vertices alone.
constexpr std::size_t kFewestFairEdges = 6;
// The facets that pass through others. A search ends at this number of pairs, and a repair at this share of
// the mesh.
constexpr unsigned int kMostCrossings = 20000;
constexpr double kMostCrossingShare = 0.02;

std::vector<Point> to_points(const TriangleMesh& mesh) {
  std::vector<Point> points;
  points.reserve(mesh.vertices.size());
  for (const Vec3d& p : mesh.vertices) points.emplace_back(p.x, p.y, p.z);
  return points;
}

Soup to_soup(const TriangleMesh& mesh) {
  Soup soup;
  soup.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) soup.push_back({a, b, c});
  return soup;
}

// A mesh of polygons, cut open where edges or vertices are not manifold.
SurfaceMesh to_surface(const TriangleMesh& mesh) {
  std::vector<Point> points = to_points(mesh);
  Soup soup = to_soup(mesh);
  PMP::orient_polygon_soup(points, soup);
  SurfaceMesh surface;
  PMP::polygon_soup_to_polygon_mesh(points, soup, surface);
  return surface;
}

TriangleMesh to_mesh(const SurfaceMesh& surface) {
  TriangleMesh mesh;
  std::vector<std::uint32_t> number(surface.num_vertices() + surface.number_of_removed_vertices());
  mesh.vertices.reserve(surface.number_of_vertices());
  for (const auto v : surface.vertices()) {
    number[static_cast<std::size_t>(v)] = static_cast<std::uint32_t>(mesh.vertices.size());
    const Point& p = surface.point(v);
    mesh.vertices.push_back({p.x(), p.y(), p.z()});
  }
  mesh.triangles.reserve(surface.number_of_faces());
  for (const Facet f : surface.faces()) {
    Triangle t{};
    std::size_t k = 0;
    for (const auto v : CGAL::vertices_around_face(surface.halfedge(f), surface)) {
      if (k < 3) t[k++] = number[static_cast<std::size_t>(v)];
    }
    mesh.triangles.push_back(t);
  }
  return mesh;
}

double facet_area(const SurfaceMesh& surface, const std::vector<Facet>& facets) {
  return PMP::area(facets, surface);
}

std::size_t hole_edges(const SurfaceMesh& surface, HalfEdge border) {
  return CGAL::halfedges_around_face(border, surface).size();
}

// Fills the hole on this border and returns the facets; none where it cannot.
std::vector<Facet> fill_hole(SurfaceMesh& surface, HalfEdge border, std::size_t edges, bool cubic) {
  std::vector<Facet> facets;
  std::vector<SurfaceMesh::Vertex_index> vertices;
  const auto options = CGAL::parameters::use_delaunay_triangulation(true).do_not_use_cubic_algorithm(!cubic);
  if (edges < kFewestFairEdges) {
    PMP::triangulate_hole(surface, border, std::back_inserter(facets), options);
  } else {
    PMP::triangulate_refine_and_fair_hole(surface, border, std::back_inserter(facets),
                                          std::back_inserter(vertices), options);
  }
  return facets;
}

}  // namespace

FilledMesh fill_holes(const TriangleMesh& mesh, const std::string& name, const Progress& progress) {
  return guarded(name, "its holes cannot be filled", [&] {
    SurfaceMesh surface = to_surface(mesh);
    FilledMesh filled;
    filled.stitched_edges = static_cast<std::int64_t>(PMP::stitch_borders(surface));
    std::vector<HalfEdge> borders;
    PMP::extract_boundary_cycles(surface, std::back_inserter(borders));
    double steps = 0.0;
    for (std::size_t i = 0; i < borders.size(); ++i) {
      if (!report(progress, static_cast<double>(i) / static_cast<double>(borders.size()), "holes")) {
        throw WorkError("stopped while the holes of the mesh were filled");
      }
      const std::size_t edges = hole_edges(surface, borders[i]);
      const double cubed = static_cast<double>(edges) * static_cast<double>(edges * edges) / 6.0;
      const bool counted = edges > kUncountedEdges;
      const bool cubic = !counted || (edges <= kMostCubicEdges && steps + cubed <= kMostCubicSteps);
      if (counted && cubic) steps += cubed;
      const std::vector<Facet> facets = fill_hole(surface, borders[i], edges, cubic);
      if (facets.empty()) {
        throw InputError(name + ": has a hole of " + std::to_string(edges) + " edges that cannot be filled");
      }
      filled.holes.push_back(facet_area(surface, facets));
    }
    filled.mesh = to_mesh(surface);
    return filled;
  });
}

UncrossedMesh remove_crossings(const TriangleMesh& mesh, const std::string& name, const Progress& progress) {
  return guarded(name, "its crossings cannot be removed", [&] {
    SurfaceMesh surface = to_surface(mesh);
    std::vector<std::pair<Facet, Facet>> pairs;
    PMP::self_intersections(surface, std::back_inserter(pairs),
                            CGAL::parameters::maximum_number(kMostCrossings));
    std::set<Facet> crossing;
    for (const auto& [a, b] : pairs) {
      crossing.insert(a);
      crossing.insert(b);
    }
    UncrossedMesh uncrossed;
    uncrossed.crossing_facets = static_cast<std::int64_t>(crossing.size());
    const double share =
        static_cast<double>(crossing.size()) / static_cast<double>(surface.number_of_faces());
    if (pairs.size() >= kMostCrossings || share > kMostCrossingShare) {
      throw InputError(name + ": too many facets pass through others (" + std::to_string(crossing.size()) +
                       " of " + std::to_string(surface.number_of_faces()) + ")");
    }
    if (!report(progress, 0.3, "crossings")) throw WorkError("stopped while the mesh was repaired");
    uncrossed.has_no_crossings = crossing.empty() || PMP::experimental::remove_self_intersections(surface);
    uncrossed.mesh = to_mesh(surface);
    return uncrossed;
  });
}

TriangleMesh alpha_wrapped(const TriangleMesh& mesh, double alpha, double offset, const std::string& name) {
  return guarded(name, "cannot be wrapped", [&] {
    const std::vector<Point> points = to_points(mesh);
    SurfaceMesh wrap;
    CGAL::alpha_wrap_3(points, to_soup(mesh), alpha, offset, wrap);
    return to_mesh(wrap);
  });
}

}  // namespace astrolith
