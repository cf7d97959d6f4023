#include "tasks/gravity/compute_gravity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "geometry/mesh_measure.h"
#include "gravity/body_mass.h"
#include "numerics/errors.h"
#include "numerics/vec3_json.h"

namespace astrolith {
namespace {

// Adds what a body of `weight` times unit density adds to the inertia about a point at -d from its centre.
void add_inertia(const BodyMass& mass, double weight, const Vec3d& d, Matrix3& inertia) {
  const std::array<double, 3> e{d.x, d.y, d.z};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double steiner = (i == k ? squared_norm(d) : 0.0) - e[i] * e[k];
      inertia[i][k] += weight * (mass.inertia[i][k] + mass.volume * steiner);
    }
  }
}

using Json = nlohmann::ordered_json;

double farthest_vertex(const TriangleMesh& mesh, const Vec3d& center) {
  double farthest = 0.0;
  for (const Vec3d& p : mesh.vertices) farthest = std::max(farthest, norm(p - center));
  return farthest;
}

// Volume, area, mass, centre of mass, moments and axes. SI units; the centre in metres of the body's frame.
// `mass` is that of the whole with its parts, as multiples of the density; `volume` is in the body's unit.
Json mass_json(const GravityBody& body, const BodyMass& mass, double volume, double density) {
  const double m = body.metres, fifth = density * m * m * m * m * m;
  const PrincipalAxes principal = principal_axes(mass.inertia);
  Json inertia = Json::array(), axes = Json::array(), moments = Json::array();
  for (std::size_t i = 0; i < 3; ++i) {
    inertia.push_back({fifth * mass.inertia[i][0], fifth * mass.inertia[i][1], fifth * mass.inertia[i][2]});
    moments.push_back(fifth * principal.moments[i]);
    axes.push_back(to_json(principal.axes[i]));
  }
  return {{"volume_m3", volume * m * m * m},
          {"area_m2", surface_area(body.mesh) * m * m},
          {"mass_kg", density * mass.volume * m * m * m},
          {"center_of_mass_m", to_json(m * mass.center)},
          {"inertia_kg_m2", inertia},
          {"principal_moments_kg_m2", moments},
          {"principal_axes", axes}};
}

// The file, the density and the mass of each part.
Json parts_json(const GravityBody& body, const std::vector<BodyPart>& parts) {
  const double m = body.metres;
  Json part_list = Json::array();
  for (const BodyPart& part : parts) {
    part_list.push_back({{"shape", part.name},
                         {"density_kg_m3", part.density},
                         {"volume_m3", part.mass.volume * m * m * m},
                         {"mass_kg", part.density * part.mass.volume * m * m * m}});
  }
  return part_list;
}

// Coefficients about the centre of mass for the reference radius in the body's unit; 0 stands for the
// distance of the farthest vertex.
Json coefficients_json(const GravityBody& body, const BodyMass& mass, const std::vector<BodyPart>& parts,
                       double radius, int degree, const Progress& progress) {
  const double reference = radius > 0.0 ? radius : farthest_vertex(body.mesh, mass.center);
  std::vector<GravityCoefficient> all =
      gravity_coefficients(body.mesh, mass.center, reference, degree, progress);
  if (!parts.empty()) {
    double homogeneous = mass.volume;
    for (const BodyPart& part : parts) homogeneous -= part.share * part.mass.volume;
    for (GravityCoefficient& k : all) k.c *= homogeneous / mass.volume, k.s *= homogeneous / mass.volume;
  }
  for (const BodyPart& part : parts) {
    const std::vector<GravityCoefficient> own =
        gravity_coefficients(part.body.mesh, mass.center, reference, degree, progress);
    const double weight = part.share * part.mass.volume / mass.volume;
    for (std::size_t i = 0; i < all.size(); ++i) all[i].c += weight * own[i].c, all[i].s += weight * own[i].s;
  }
  Json rows = Json::array();
  for (const GravityCoefficient& k : all) rows.push_back({k.degree, k.order, k.c, k.s});
  return {{"normalisation", "4 pi, without the sign of Condon and Shortley"},
          {"about", "the centre of mass, axes of the file"},
          {"reference_radius_m", reference * body.metres},
          {"degree_order_c_s", rows}};
}

struct Evaluation {
  std::vector<Attraction> attractions;
  AchievedError error;
};

Evaluation evaluated(const GravityBody& body, const GravityPlaces& places, const GravityOptions& options,
                     const StageProgress& progress) {
  const PolyhedronGravity gravity(body.mesh, {}, progress("tree"));
  Evaluation result;
  result.attractions = options.exact ? gravity.exactly_at(places.points, progress("gravity")).values
                                     : gravity.at(places.points, options.tolerance, progress("gravity"));
  result.error = achieved_error(gravity, places.points, result.attractions, options.sample, options.seed,
                                progress("check"));
  add_parts(options.parts, places.points, options.tolerance, options.exact, progress("parts"),
            result.attractions);
  return result;
}

Rotation choose_rotation(const GravityBody& body, const BodyMass& mass, const GravityOptions& options) {
  const double rate = options.period > 0.0 ? 2.0 * std::numbers::pi / (3600.0 * options.period) : 0.0;
  return {body.metres * mass.center, options.axis, rate};
}

}  // namespace

BodyMass with_parts(const BodyMass& whole, const std::vector<BodyPart>& parts) {
  if (parts.empty()) return whole;
  BodyMass all;
  all.volume = whole.volume;
  all.center = whole.volume * whole.center;
  for (const BodyPart& part : parts) {
    all.volume += part.share * part.mass.volume;
    all.center += part.share * part.mass.volume * part.mass.center;
  }
  if (!(all.volume > 0.0)) throw InputError("--density-of: the parts leave no mass; give higher densities");
  all.center = all.center * (1.0 / all.volume);
  add_inertia(whole, 1.0, whole.center - all.center, all.inertia);
  for (const BodyPart& part : parts) {
    add_inertia(part.mass, part.share, part.mass.center - all.center, all.inertia);
  }
  return all;
}

void add_parts(const std::vector<BodyPart>& parts, const std::vector<Vec3d>& points, double tolerance,
               bool exact, const Progress& progress, std::vector<Attraction>& attractions) {
  for (const BodyPart& part : parts) {
    const PolyhedronGravity gravity(part.body.mesh, {}, progress);
    const std::vector<Attraction> own =
        exact ? gravity.exactly_at(points, progress).values : gravity.at(points, tolerance, progress);
    for (std::size_t i = 0; i < own.size(); ++i) {
      attractions[i].potential += part.share * own[i].potential;
      attractions[i].acceleration += part.share * own[i].acceleration;
    }
  }
}

ComputedGravity compute_gravity(const GravityBody& body, const GravityPlaces& places,
                                const GravityOptions& options, const StageProgress& progress) {
  const BodyMass homogeneous = body_mass(body.mesh), mass = with_parts(homogeneous, options.parts);
  const Evaluation evaluation = evaluated(body, places, options, progress);
  const std::vector<PointGravity> values =
      point_gravity(in_metres(places.points, body.metres), evaluation.attractions, options.density,
                    body.metres, choose_rotation(body, mass, options));
  const SurfaceMeans means =
      surface_means(values, places.areas.empty() ? std::vector<double>(values.size()) : places.areas);
  ComputedGravity result{gravity_columns(places, values, means),
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
  if (options.sample > 0) {
    result.figures["achieved_error"] = error_json(evaluation.error, options.exact ? 0.0 : options.tolerance);
  }
  return result;
}

}  // namespace astrolith
