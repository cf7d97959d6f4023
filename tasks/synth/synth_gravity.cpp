#include "tasks/synth/synth_mesh_internal.h"

#include <numbers>

#include "gravity/body_mass.h"
#include "numerics/errors.h"
#include "numerics/length_unit.h"
#include "tasks/gravity/gravity_table.h"

namespace astrolith {
namespace {

constexpr double kTolerance = 1e-6;
constexpr int kSample = 20;

}  // namespace

void check_gravity(const GravityRequest& request, const Recipe& recipe) {
  if (!request.wanted()) return;
  if (!(request.density_and_period[0] > 0.0))
    throw InputError("--gravity: the density must be above 0 kg/m3; give another");
  if (!(request.density_and_period[1] >= 0.0))
    throw InputError("--gravity: the period must not be below 0 hours; 0 is a body at rest");
  if (recipe.length_unit == "px")
    throw InputError("--gravity: a recipe in px has no size; state m or km in it");
}

std::vector<VertexValues> vertex_gravity(Job& job, const GravityRequest& request, const Recipe& recipe,
                                         const TriangleMesh& mesh) {
  const double density = request.density_and_period[0], period = request.density_and_period[1];
  const double metres = metres_of(recipe.length_unit);
  const GravityPlaces places = vertex_places(mesh);
  const PolyhedronGravity gravity(mesh, {}, job.progress("tree"));
  const std::vector<Attraction> attractions = gravity.at(places.points, kTolerance, job.progress("gravity"));
  const Rotation rotation{metres * body_mass(mesh).center,
                          {0, 0, 1},
                          period > 0.0 ? 2.0 * std::numbers::pi / (3600.0 * period) : 0.0};
  const std::vector<PointGravity> values =
      point_gravity(in_metres(places.points, metres), attractions, density, metres, rotation);
  const SurfaceMeans means = surface_means(values, places.areas);
  job.summary["gravity"] = surface_json(places, values, means);
  job.summary["gravity"]["achieved_error"] = error_json(
      achieved_error(gravity, places.points, attractions, kSample, job.seed, job.progress("check")),
      kTolerance);
  std::vector<VertexValues> quantities;
  const std::vector<GravityColumn> columns = gravity_columns(places, values, means);
  for (std::size_t k = 3; k < columns.size(); ++k) quantities.push_back({columns[k].name, columns[k].values});
  return quantities;
}

}  // namespace astrolith
