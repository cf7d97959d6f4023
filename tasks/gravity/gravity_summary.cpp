#include "tasks/gravity/gravity_summary.h"

#include <algorithm>
#include <cmath>

#include "geometry/mesh_measure.h"
#include "numerics/vec3_json.h"

namespace astrolith {
namespace {

using Json = nlohmann::ordered_json;

double farthest_vertex(const TriangleMesh& mesh, const Vec3d& center) {
  double farthest = 0.0;
  for (const Vec3d& p : mesh.vertices) farthest = std::max(farthest, norm(p - center));
  return farthest;
}

}  // namespace

Json mass_json(const GravityBody& body, const BodyMass& mass, double volume, double density) {
  const double m = body.metres, fifth = density * m * m * m * m * m;
  const PrincipalAxes principal = principal_axes(mass.inertia);
  Json inertia = Json::array(), axes = Json::array(), moments = Json::array();
  for (std::size_t i = 0; i < 3; ++i) {
    inertia.push_back({fifth * mass.inertia[i][0], fifth * mass.inertia[i][1], fifth * mass.inertia[i][2]});
    moments.push_back(fifth * principal.moments[i]);
    axes.push_back(json_of(principal.axes[i]));
  }
  return {{"volume_m3", volume * m * m * m},
          {"area_m2", surface_area(body.mesh) * m * m},
          {"mass_kg", density * mass.volume * m * m * m},
          {"center_of_mass_m", json_of(m * mass.center)},
          {"inertia_kg_m2", inertia},
          {"principal_moments_kg_m2", moments},
          {"principal_axes", axes}};
}

Json parts_json(const GravityBody& body, const std::vector<BodyPart>& parts) {
  const double m = body.metres;
  Json list_of_parts = Json::array();
  for (const BodyPart& part : parts) {
    list_of_parts.push_back({{"shape", part.name},
                             {"density_kg_m3", part.density},
                             {"volume_m3", part.mass.volume * m * m * m},
                             {"mass_kg", part.density * part.mass.volume * m * m * m}});
  }
  return list_of_parts;
}

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

}  // namespace astrolith
