#include "tasks/gravity/body_gravity.h"

#include <numbers>

#include "gravity/body_mass.h"
#include "tasks/gravity/gravity_summary.h"

namespace astrolith {
namespace {

struct Evaluation {
  std::vector<Attraction> attractions;
  AchievedError error;
};

Evaluation evaluated(const GravityBody& body, const GravityPlaces& places, const BodyGravityOptions& options,
                     const StageProgress& progress) {
  const PolyhedronGravity gravity(body.mesh, {}, progress("tree"));
  Evaluation result;
  if (options.exact) {
    result.attractions = gravity.exactly_at(places.points, progress("gravity"));
    add_parts(options.parts, places.points, options.tolerance, true, progress("parts"), result.attractions);
    return result;
  }
  result.attractions = gravity.at(places.points, options.tolerance, progress("gravity"));
  result.error = achieved_error(gravity, places.points, result.attractions, options.sample, options.seed,
                                progress("check"));
  add_parts(options.parts, places.points, options.tolerance, false, progress("parts"), result.attractions);
  return result;
}

Rotation rotation_of(const GravityBody& body, const BodyMass& mass, const BodyGravityOptions& options) {
  const double rate = options.period > 0.0 ? 2.0 * std::numbers::pi / (3600.0 * options.period) : 0.0;
  return {body.metres * mass.center, options.axis, rate};
}

}  // namespace

BodyGravity body_gravity(const GravityBody& body, const GravityPlaces& places,
                         const BodyGravityOptions& options, const StageProgress& progress) {
  const BodyMass homogeneous = body_mass(body.mesh), mass = with_parts(homogeneous, options.parts);
  const Evaluation evaluation = evaluated(body, places, options, progress);
  const std::vector<PointGravity> values =
      point_gravity(in_metres(places.points, body.metres), evaluation.attractions, options.density,
                    body.metres, rotation_of(body, mass, options));
  const SurfaceMeans means =
      surface_means(values, places.areas.empty() ? std::vector<double>(values.size()) : places.areas);
  BodyGravity result{gravity_columns(places, values, means),
                     {{"unit", body.unit},
                      {"facets", body.mesh.triangles.size()},
                      {"density_kg_m3", options.density},
                      {"period_h", options.period}}};
  result.figures["body"] = mass_json(body, mass, homogeneous.volume, options.density);
  if (!options.parts.empty()) result.figures["parts"] = parts_json(body, options.parts);
  result.figures["harmonics"] =
      coefficients_json(body, mass, options.parts, options.radius, options.degree, progress("harmonics"));
  result.figures["places"] = places.kind;
  result.figures["count"] = values.size();
  result.figures["values"] = surface_json(places, values, means);
  if (!options.exact && options.sample > 0) {
    result.figures["achieved_error"] = error_json(evaluation.error, options.tolerance);
  }
  return result;
}

}  // namespace astrolith
