#include "tasks/synth/surface_gravity.h"

#include <numbers>
#include <utility>

#include "gravity/body_mass.h"
#include "numerics/errors.h"
#include "numerics/length_unit.h"
#include "synthesis/field/field_mesh.h"

namespace astrolith {
namespace {

constexpr double kTolerance = 1e-6;
constexpr int kSample = 20;

}  // namespace

void check_gravity(const std::vector<double>& density_and_period, const Recipe& recipe) {
  if (density_and_period.empty()) return;
  if (!(density_and_period[0] > 0.0))
    throw InputError("--gravity: the density must be above 0 kg/m3; give another");
  if (!(density_and_period[1] >= 0.0))
    throw InputError("--gravity: the period must not be below 0 hours; 0 is a body at rest");
  if (recipe.length_unit == "px")
    throw InputError("--gravity: a recipe in px has no size; state m or km in it");
}

PatchBody make_patch_body(const Job& job, const MeshPart& patch) {
  constexpr int kCells = 256, kCoarseCells = 64;
  const ImplicitField field = make_region_field(patch.recipe, patch.file, {}, {}, &patch.field);
  const auto meshed = [&](int cells) {
    MeshCollector body;
    mesh_field(field, field.bounds(), cells, body, job.progress("body"));
    return std::move(body.mesh);
  };
  return {meshed(kCells), meshed(kCoarseCells)};
}

SurfaceGravity::SurfaceGravity(const Job& job, const MeshPart& part, const TriangleMesh& body)
    : density_(part.spec.gravity[0]),
      metres_(metres_per_unit(part.recipe.length_unit)),
      gravity_(body, {}, job.progress("tree")),
      job_(job) {
  const double period = part.spec.gravity[1];
  rotation_.center = metres_ * body_mass(body).center;
  rotation_.rate = period > 0.0 ? 2.0 * std::numbers::pi / (3600.0 * period) : 0.0;
}

std::vector<PointGravity> SurfaceGravity::find_values(std::span<const Vec3d> points,
                                                      std::span<const Attraction> attractions) const {
  return point_gravity(in_metres(points, metres_), attractions, density_, metres_, rotation_);
}

std::vector<PointGravity> SurfaceGravity::at(std::span<const Vec3d> points) const {
  return find_values(points, gravity_.at(points, kTolerance, job_.progress("gravity")));
}

std::vector<VertexValues> SurfaceGravity::at_vertices(Job& job, const TriangleMesh& mesh, const Vec3d& center,
                                                      const TriangleMesh& body) const {
  GravityPlaces places = vertex_places(mesh);
  for (Vec3d& p : places.points) p += center;
  const std::vector<Attraction> attractions = gravity_.at(places.points, kTolerance, job.progress("gravity"));
  const std::vector<PointGravity> values = find_values(places.points, attractions);
  const GravityPlaces body_places = &mesh == &body ? GravityPlaces{} : vertex_places(body);
  const SurfaceMeans means = &mesh == &body ? surface_means(values, places.areas)
                                            : surface_means(at(body_places.points), body_places.areas);
  job.summary["gravity"] = surface_json(places, values, means);
  job.summary["gravity"]["achieved_error"] = error_json(
      achieved_error(gravity_, places.points, attractions, kSample, job.seed, job.progress("check")),
      kTolerance);
  std::vector<VertexValues> quantities;
  const std::vector<GravityColumn> columns = gravity_columns(places, values, means);
  for (std::size_t k = 3; k < columns.size(); ++k) quantities.push_back({columns[k].name, columns[k].values});
  return quantities;
}

}  // namespace astrolith
