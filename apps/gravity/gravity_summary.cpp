#include "apps/gravity/gravity_summary.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/mesh_measure.h"

namespace astrolith {
namespace {

using Json = nlohmann::ordered_json;

Json list(const Vec3d& v) { return {v.x, v.y, v.z}; }

// The least, the greatest and, with weights, the mean of a quantity.
class Range {
 public:
  void add(double value, double weight) {
    least_ = std::min(least_, value);
    most_ = std::max(most_, value);
    sum_ += weight * value;
    weights_ += weight;
  }
  Json json() const {
    return {{"min", least_}, {"mean", weights_ > 0.0 ? sum_ / weights_ : 0.0}, {"max", most_}};
  }

 private:
  double least_ = std::numeric_limits<double>::infinity(), most_ = -least_, sum_ = 0.0, weights_ = 0.0;
};

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

Json coefficients_json(const GravityBody& body, const BodyMass& mass, double radius, int degree) {
  const double reference = radius > 0.0 ? radius : farthest_vertex(body.mesh, mass.center);
  Json rows = Json::array();
  for (const GravityCoefficient& k : gravity_coefficients(body.mesh, mass.center, reference, degree)) {
    rows.push_back({k.degree, k.order, k.c, k.s});
  }
  return {{"normalisation", "4 pi, without the sign of Condon and Shortley"},
          {"about", "the centre of mass, axes of the file"},
          {"reference_radius_m", reference * body.metres},
          {"degree_order_c_s", rows}};
}

Json surface_json(const GravityPlaces& places, std::span<const PointGravity> values,
                  const SurfaceMeans& means) {
  Range potential, geopotential, gravity, slope, height, escape;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double weight = places.areas.empty() ? 1.0 : places.areas[i];
    potential.add(values[i].potential, weight);
    geopotential.add(values[i].geopotential, weight);
    gravity.add(norm(values[i].effective), weight);
    escape.add(std::sqrt(std::max(-2.0 * values[i].potential, 0.0)), weight);
    if (places.normals.empty()) continue;
    slope.add(slope_degrees(places.normals[i], values[i].effective), weight);
    height.add(elevation(values[i], means), weight);
  }
  Json json{{"potential_J_kg", potential.json()},
            {"geopotential_J_kg", geopotential.json()},
            {"effective_gravity_m_s2", gravity.json()},
            {"escape_speed_m_s", escape.json()}};
  if (places.normals.empty()) return json;
  double sum = 0.0;
  for (const PointGravity& value : values) sum += value.geopotential;
  json["geopotential_J_kg"]["mean_of_places"] = sum / static_cast<double>(values.size());
  json["slope_deg"] = slope.json();
  json["elevation_m"] = height.json();
  return json;
}

Json error_json(const AchievedError& error, double tolerance) {
  return {{"tolerance", tolerance},
          {"sample", error.points},
          {"largest", error.largest},
          {"rms", error.rms},
          {"largest_of_potential", error.largest_of_potential}};
}

}  // namespace astrolith
