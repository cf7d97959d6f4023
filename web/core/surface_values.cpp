#include "web/core/surface_values.h"

#include <algorithm>
#include <numbers>
#include <span>
#include <utility>
#include <variant>

#include "geometry/mesh_measure.h"
#include "gravity/body_mass.h"
#include "gravity/polyhedron_gravity.h"
#include "gravity/surface_gravity.h"
#include "numerics/errors.h"
#include "numerics/length_unit.h"
#include "synthesis/field/surface_colors.h"
#include "synthesis/field/surface_labels.h"

namespace astrolith {
namespace {

constexpr double kTolerance = 1e-3;  // of the acceleration: .06 degrees of a slope

std::vector<MeshVertex> mesh_vertices(const TriangleMesh& mesh) {
  std::vector<MeshVertex> vertices;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    vertices.push_back({to_float(mesh.vertices[i]), to_float(mesh.normals[i])});
  return vertices;
}

// The density and the period that the recipe states, those of its erosion first.
LocalGravity stated_gravity(const Recipe& recipe) {
  if (recipe.erosion) return {recipe.erosion->density, recipe.erosion->rotation_period};
  for (const Layer& layer : recipe.layers) {
    const auto* const boulders = std::get_if<BoulderLayer>(&layer);
    if (boulders != nullptr && boulders->gravity) return *boulders->gravity;
  }
  return {};
}

std::vector<double> vertex_areas(const TriangleMesh& mesh) {
  std::vector<double> areas(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) areas[v] += triangle_area(mesh, t) / 3.0;
  }
  return areas;
}

std::vector<PointGravity> gravity_at_vertices(const Recipe& recipe, const std::string& name,
                                              const TriangleMesh& mesh) {
  if (recipe.length_unit != "m" && recipe.length_unit != "km")
    throw InputError(name + ": length_unit: is no length, so that there is no gravity; state m or km");
  const double metres = metres_per_unit(recipe.length_unit);
  const LocalGravity stated = stated_gravity(recipe);
  Rotation rotation;
  rotation.center = metres * body_mass(mesh).center;
  if (stated.rotation_period > 0.0)
    rotation.rate = 2.0 * std::numbers::pi / (3600.0 * stated.rotation_period);
  std::vector<Vec3d> places;
  for (const Vec3d& p : mesh.vertices) places.push_back(metres * p);
  const PolyhedronGravity gravity(mesh);
  return point_gravity(places, gravity.at(mesh.vertices, kTolerance), stated.density, metres, rotation);
}

SurfaceValues slopes(const std::vector<PointGravity>& gravity, const TriangleMesh& mesh) {
  SurfaceValues made{{}, "degrees", {}};
  for (std::size_t i = 0; i < gravity.size(); ++i)
    made.values.push_back(static_cast<float>(slope_degrees(mesh.normals[i], gravity[i].effective)));
  return made;
}

SurfaceValues heights(const std::vector<PointGravity>& gravity, const TriangleMesh& mesh) {
  const SurfaceMeans means = surface_means(gravity, vertex_areas(mesh));
  SurfaceValues made{{}, "m", {}};
  for (const PointGravity& value : gravity)
    made.values.push_back(static_cast<float>(elevation(value, means)));
  return made;
}

SurfaceValues albedos(const Recipe& recipe, const std::string& name, const ImplicitField& field,
                      const TriangleMesh& mesh) {
  const SurfaceColors colors(recipe, name, field);
  if (!colors.has_albedo()) throw InputError(name + ": albedo: is absent; add it to the recipe");
  std::vector<Vec3f> found(mesh.vertices.size());
  colors.find_albedo({}, mesh_vertices(mesh), found);
  SurfaceValues made;
  for (const Vec3f& albedo : found) made.values.push_back((albedo.x + albedo.y + albedo.z) / 3.0f);
  return made;
}

SurfaceValues labels(const Recipe& recipe, const ImplicitField& field, const TriangleMesh& mesh) {
  const SurfaceLabels of(recipe, field);
  const std::vector<MeshVertex> vertices = mesh_vertices(mesh);
  std::vector<VertexLabel> found(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); i += kLabelsChunk) {
    const std::size_t n = std::min(kLabelsChunk, vertices.size() - i);
    of.label({}, std::span(vertices).subspan(i, n), std::span(found).subspan(i, n));
  }
  SurfaceValues made{{}, "", of.legend()};
  for (const VertexLabel& at : found) made.values.push_back(static_cast<float>(at.label));
  return made;
}

}  // namespace

SurfaceValues find_surface_values(const std::string& what, const Recipe& recipe, const std::string& name,
                                  const ImplicitField& field, const TriangleMesh& mesh) {
  if (what == "slope") return slopes(gravity_at_vertices(recipe, name, mesh), mesh);
  if (what == "height") return heights(gravity_at_vertices(recipe, name, mesh), mesh);
  if (what == "albedo") return albedos(recipe, name, field, mesh);
  if (what == "label") return labels(recipe, field, mesh);
  throw InputError("values: there are slope, height, albedo and label, not " + what);
}

}  // namespace astrolith
