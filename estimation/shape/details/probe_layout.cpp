#include "estimation/shape/details/probe_layout.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/surface/mesh_sampling.h"
#include "numerics/hash_random.h"
#include "numerics/tangent_frame.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/field/implicit_field.h"

namespace astrolith {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kMostTriangles = 50000.0;
constexpr double kFirstLag = 2.0;  // edges
constexpr double kLagRatio = std::numbers::sqrt2;
constexpr std::size_t kFewestLags = 3;
constexpr double kLongestLag = 0.08;  // fraction of the diagonal; longer tangents leave a curved body

double edge_of_area(double triangle_area) { return std::sqrt(4.0 / std::sqrt(3.0) * triangle_area); }

Vec3d tangent(const Vec3d& n, double angle) {
  const auto [u, v] = crossed_tangents(n);
  return std::cos(angle) * u + std::sin(angle) * v;
}

std::vector<double> choose_lags(double edge, double sphere_distance) {
  const double longest = std::min(sphere_distance, kLongestLag);
  std::vector<double> lags;
  for (double r = kFirstLag * edge; lags.size() < kFewestLags || r <= longest; r *= kLagRatio) {
    lags.push_back(r);
  }
  return lags;
}

// The triangles of marching cubes have on average the area of an equilateral triangle with the edge of a
// cell.
TriangleMesh mesh_of_base(const MetaballBody& base, double edge) {
  Recipe recipe;
  recipe.body = base;
  const ImplicitField field(recipe);
  const double cells = field.bounds().longest_side() / edge;
  MeshCollector collector;
  mesh_field(field, field.bounds(), std::max(16, static_cast<int>(std::lround(cells))), collector);
  return std::move(collector.mesh);
}

void add_lines(const SurfaceSamples& sites, std::uint64_t seed, ProbeLayout& layout) {
  const SurfaceTree tree(layout.mesh);
  layout.triples.resize(layout.lags.size());
  const auto add = [&](const Vec3d& p) {
    layout.places.push_back(nearest_place(layout.mesh, tree, p));
    return static_cast<std::uint32_t>(layout.places.size() - 1);
  };
  for (std::size_t j = 0; j < sites.points.size(); ++j) {
    CounterRandom random(seed, j);
    const Vec3d& q = sites.points[j];
    const std::uint32_t middle = add(q);
    for (std::size_t k = 0; k < layout.lags.size(); ++k) {
      const Vec3d step = layout.lags[k] * tangent(sites.normals[j], random.uniform(0.0, kTurn));
      const std::uint32_t before = add(q - step), after = add(q + step);
      layout.triples[k].push_back({before, middle, after});
    }
  }
}

}  // namespace

std::vector<ProbePoint> ProbeLayout::vertex_points() const {
  std::vector<ProbePoint> points;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    points.push_back({mesh.vertices[v], mesh.normals[v]});
  }
  return points;
}

std::vector<ProbePoint> ProbeLayout::place_points() const {
  std::vector<ProbePoint> points;
  for (const MeshPlace& place : places) {
    points.push_back({place.interpolate(mesh.triangles, mesh.vertices),
                      normalized(place.interpolate(mesh.triangles, mesh.normals))});
  }
  return points;
}

std::vector<double> ProbeLayout::at_places(const std::vector<double>& of_vertices) const {
  std::vector<double> heights;
  for (const MeshPlace& place : places) heights.push_back(place.interpolate(mesh.triangles, of_vertices));
  return heights;
}

MeshPlace nearest_place(const TriangleMesh& mesh, const SurfaceTree& tree, const Vec3d& p) {
  const ClosestPoint at = tree.closest(p);
  const Triangle& t = mesh.triangles[at.triangle];
  const Vec3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
  const Vec3d n = cross(b - a, c - a);
  const double whole = squared_norm(n);
  if (!(whole > 0.0)) return {at.triangle, {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0}};
  return {
      at.triangle,
      {dot(cross(b - at.point, c - at.point), n) / whole, dot(cross(c - at.point, a - at.point), n) / whole,
       dot(cross(a - at.point, b - at.point), n) / whole}};
}

double facet_edge(const TargetBody& target) {
  return edge_of_area(target.area / static_cast<double>(target.surface.triangles.size()));
}

double probe_edge(const TargetBody& target) {
  return std::max(facet_edge(target), edge_of_area(target.area / kMostTriangles));
}

ProbeLayout lay_out_probes(const TargetBody& target, const MetaballBody& base, int lines,
                           std::uint64_t seed) {
  const double edge = probe_edge(target);
  ProbeLayout layout;
  layout.mesh = mesh_of_base(base, edge);
  layout.lags = choose_lags(edge, std::sqrt(target.area / static_cast<double>(base.num_metaballs())));
  add_lines(sample_surface(layout.mesh, lines, seed, SampleNormals::interpolated), seed, layout);
  return layout;
}

}  // namespace astrolith
