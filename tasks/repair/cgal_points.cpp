#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Delaunay_triangulation_cell_base_with_circumcenter_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/facets_in_complex_2_to_triangle_mesh.h>
#include <CGAL/Implicit_surface_3.h>
#include <CGAL/Poisson_reconstruction_function.h>
#include <CGAL/Random.h>
#include <CGAL/Robust_circumcenter_traits_3.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_cell_base_3.h>
#include <CGAL/Surface_mesh_complex_2_in_triangulation_3.h>
#include <CGAL/Surface_mesh_default_criteria_3.h>
#include <CGAL/Surface_mesh_vertex_base_3.h>
#include <CGAL/jet_estimate_normals.h>
#include <CGAL/jet_smooth_point_set.h>
#include <CGAL/make_surface_mesh.h>
#include <CGAL/mst_orient_normals.h>
#include <CGAL/property_map.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "tasks/repair/cgal_guard_internal.h"
#include "tasks/repair/cgal_repair_internal.h"

namespace astrolith {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Oriented = std::pair<Point, Kernel::Vector_3>;
using PointMap = CGAL::First_of_pair_property_map<Oriented>;
using NormalMap = CGAL::Second_of_pair_property_map<Oriented>;

std::vector<Oriented> to_oriented(const std::vector<Vec3d>& points, const std::vector<Vec3d>& normals) {
  std::vector<Oriented> made;
  made.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3d& p = points[i];
    const Vec3d n = normals.empty() ? Vec3d{} : normals[i];
    made.emplace_back(Point(p.x, p.y, p.z), Kernel::Vector_3(n.x, n.y, n.z));
  }
  return made;
}

// A point that knows its place in the order of the points, which an orientation changes.
using Numbered = std::pair<Oriented, std::size_t>;
struct NumberedPoint {
  using key_type = Numbered;
  using value_type = Point;
  using reference = const Point&;
  using category = boost::lvalue_property_map_tag;
  friend const Point& get(NumberedPoint /*map*/, const Numbered& all) { return all.first.first; }
};
struct NumberedNormal {
  using key_type = Numbered;
  using value_type = Kernel::Vector_3;
  using reference = const Kernel::Vector_3&;
  using category = boost::read_write_property_map_tag;
  friend const Kernel::Vector_3& get(NumberedNormal /*map*/, const Numbered& all) { return all.first.second; }
  friend void put(NumberedNormal /*map*/, Numbered& all, const Kernel::Vector_3& n) { all.first.second = n; }
};

// A vertex or cell that is ordered by the time when it was made. The mesher would order it by its address,
// and make another mesh each time.
template <class Base>
class Stamped : public Base {
 public:
  using Has_timestamp = CGAL::Tag_true;
  template <class Structure>
  struct Rebind_TDS {
    using Other = Stamped<typename Base::template Rebind_TDS<Structure>::Other>;
  };
  using Base::Base;
  std::size_t time_stamp() const { return stamp_; }
  void set_time_stamp(std::size_t stamp) { stamp_ = stamp; }

 private:
  std::size_t stamp_ = static_cast<std::size_t>(-1);
};
using MeshKernel = CGAL::Robust_circumcenter_traits_3<Kernel>;
using MeshVertex = Stamped<CGAL::Surface_mesh_vertex_base_3<MeshKernel>>;
using MeshCell = Stamped<CGAL::Delaunay_triangulation_cell_base_with_circumcenter_3<
    MeshKernel, CGAL::Surface_mesh_cell_base_3<MeshKernel>>>;
using MeshTriangulation =
    CGAL::Delaunay_triangulation_3<MeshKernel, CGAL::Triangulation_data_structure_3<MeshVertex, MeshCell>>;
using Indicator = CGAL::Poisson_reconstruction_function<Kernel>;

// The zero of the function. Empty where no triangle meets it.
CGAL::Surface_mesh<Point> zero_surface(const Indicator& function, double facet, double error) {
  constexpr double kLeastAngle = 20.0;  // degrees
  constexpr double kWide = 5.0;         // the mesher's ball, in radii of the points'
  constexpr double kExact = 1e-3;       // of the error: how well vertices lie on the surface
  const double radius = kWide * std::sqrt(function.bounding_sphere().squared_radius());
  const CGAL::Implicit_surface_3<Kernel, Indicator> surface(
      function, Kernel::Sphere_3(function.get_inner_point(), radius * radius), kExact * error / radius);
  MeshTriangulation triangulation;
  CGAL::Surface_mesh_complex_2_in_triangulation_3<MeshTriangulation> complex(triangulation);
  CGAL::make_surface_mesh(complex, surface,
                          CGAL::Surface_mesh_default_criteria_3<MeshTriangulation>(kLeastAngle, facet, error),
                          CGAL::Manifold_with_boundary_tag());
  CGAL::Surface_mesh<Point> mesh;
  if (triangulation.number_of_vertices() > 0) CGAL::facets_in_complex_2_to_triangle_mesh(complex, mesh);
  return mesh;
}

}  // namespace

std::vector<Vec3d> jet_smoothed(std::vector<Vec3d> points, int neighbours) {
  return guarded("points", "cannot be smoothed", [&] {
    std::vector<Point> moved;
    moved.reserve(points.size());
    for (const Vec3d& p : points) moved.emplace_back(p.x, p.y, p.z);
    CGAL::jet_smooth_point_set<CGAL::Sequential_tag>(moved, static_cast<unsigned int>(neighbours));
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = {moved[i].x(), moved[i].y(), moved[i].z()};
    return points;
  });
}

std::vector<Vec3d> jet_normals(const std::vector<Vec3d>& points, int neighbours) {
  return guarded("points", "have no normals", [&] {
    const std::vector<Oriented> oriented = to_oriented(points, {});
    std::vector<Numbered> all;
    for (std::size_t i = 0; i < oriented.size(); ++i) all.emplace_back(oriented[i], i);
    const auto maps = CGAL::parameters::point_map(NumberedPoint()).normal_map(NumberedNormal());
    CGAL::jet_estimate_normals<CGAL::Sequential_tag>(all, static_cast<unsigned int>(neighbours), maps);
    const auto unknown = CGAL::mst_orient_normals(all, static_cast<unsigned int>(neighbours), maps);
    std::vector<Vec3d> normals(points.size());
    for (auto at = all.begin(); at != unknown; ++at) {
      const Kernel::Vector_3& n = at->first.second;
      normals[at->second] = {n.x(), n.y(), n.z()};
    }
    return normals;
  });
}

TriangleMesh poisson_surface(const std::vector<Vec3d>& points, const std::vector<Vec3d>& normals,
                             double facet, double error, const std::string& name) {
  return guarded(name, "no closed surface goes through its points; give those of all sides of a body", [&] {
    CGAL::get_default_random() = CGAL::Random(0);
    const std::vector<Oriented> oriented = to_oriented(points, normals);
    TriangleMesh mesh;
    Indicator function(oriented.begin(), oriented.end(), PointMap(), NormalMap());
    if (!function.compute_implicit_function()) return mesh;
    const CGAL::Surface_mesh<Point> surface = zero_surface(function, facet, error);
    for (const auto v : surface.vertices()) {
      const Point& p = surface.point(v);
      mesh.vertices.push_back({p.x(), p.y(), p.z()});
    }
    for (const auto f : surface.faces()) {
      Triangle t{};
      std::size_t k = 0;
      for (const auto v : CGAL::vertices_around_face(surface.halfedge(f), surface)) {
        if (k < 3) t[k++] = static_cast<std::uint32_t>(v);
      }
      mesh.triangles.push_back(t);
    }
    return mesh;
  });
}

}  // namespace astrolith
