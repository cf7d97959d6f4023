#include "apps/gravity/gravity_summary.h"

#include <algorithm>
#include <cmath>

#include "geometry/mesh_measure.h"

namespace astrolith {
namespace {

using Json = nlohmann::ordered_json;

Json list(const Vec3d& v) { return {v.x, v.y, v.z}; }

double farthest_vertex(const TriangleMesh& mesh, const Vec3d& center) {
  double farthest = 0.0;
  for (const Vec3d& p : mesh.vertices) farthest = std::max(farthest, norm(p - center));
  return farthest;
}

}  // namespace

Json mass_json(const GravityBody& body, const BodyMass& mass, double density) {
  const double m = body.metres, fifth = density * m * m * m * m * m;
  const PrincipalAxes principal = principal_axes(mass.inertia);
  Json inertia = Json::array(), axes = Json::array(), moments = Json::array();
  for (std::size_t i = 0; i < 3; ++i) {
    inertia.push_back({fifth * mass.inertia[i][0], fifth * mass.inertia[i][1], fifth * mass.inertia[i][2]});
    moments.push_back(fifth * principal.moments[i]);
    axes.push_back(list(principal.axes[i]));
  }
  return {{"volume_m3", mass.volume * m * m * m},
          {"area_m2", surface_area(body.mesh) * m * m},
          {"mass_kg", density * mass.volume * m * m * m},
          {"center_of_mass_m", list(m * mass.center)},
          {"inertia_kg_m2", inertia},
          {"principal_moments_kg_m2", moments},
          {"principal_axes", axes}};
}

Json coefficients_json(const GravityBody& body, const BodyMass& mass, double radius, int degree,
                       const Progress& progress) {
  const double reference = radius > 0.0 ? radius : farthest_vertex(body.mesh, mass.center);
  Json rows = Json::array();
  for (const GravityCoefficient& k :
       gravity_coefficients(body.mesh, mass.center, reference, degree, progress)) {
    rows.push_back({k.degree, k.order, k.c, k.s});
  }
  return {{"normalisation", "4 pi, without the sign of Condon and Shortley"},
          {"about", "the centre of mass, axes of the file"},
          {"reference_radius_m", reference * body.metres},
          {"degree_order_c_s", rows}};
}

}  // namespace astrolith
