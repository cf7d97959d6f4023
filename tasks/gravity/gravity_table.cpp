#include "tasks/gravity/gravity_table.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/mesh_measure.h"

namespace astrolith {
namespace {

using Json = nlohmann::ordered_json;

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

}  // namespace

GravityPlaces facet_places(const TriangleMesh& mesh) {
  GravityPlaces places;
  places.kind = "facets";
  places.normals = triangle_normals(mesh);
  for (const Triangle& t : mesh.triangles) {
    places.points.push_back((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) * (1.0 / 3.0));
    places.areas.push_back(triangle_area(mesh, t));
  }
  return places;
}

GravityPlaces vertex_places(const TriangleMesh& mesh) {
  GravityPlaces places{mesh.vertices, vertex_normals(mesh), std::vector<double>(mesh.vertices.size()),
                       "vertices"};
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) places.areas[v] += triangle_area(mesh, t) / 3.0;
  }
  return places;
}

std::vector<Vec3d> in_metres(std::span<const Vec3d> points, double metres) {
  std::vector<Vec3d> scaled;
  for (const Vec3d& p : points) scaled.push_back(metres * p);
  return scaled;
}

std::vector<GravityColumn> gravity_columns(const GravityPlaces& places, std::span<const PointGravity> values,
                                           const SurfaceMeans& means) {
  std::vector<GravityColumn> columns;
  const auto add = [&](const char* name, const auto& find_value) {
    GravityColumn column{name, {}};
    for (std::size_t i = 0; i < values.size(); ++i) column.values.push_back(find_value(i));
    columns.push_back(std::move(column));
  };
  add("x", [&](std::size_t i) { return places.points[i].x; });
  add("y", [&](std::size_t i) { return places.points[i].y; });
  add("z", [&](std::size_t i) { return places.points[i].z; });
  add("potential_J_kg", [&](std::size_t i) { return values[i].potential; });
  add("acceleration_x_m_s2", [&](std::size_t i) { return values[i].acceleration.x; });
  add("acceleration_y_m_s2", [&](std::size_t i) { return values[i].acceleration.y; });
  add("acceleration_z_m_s2", [&](std::size_t i) { return values[i].acceleration.z; });
  add("geopotential_J_kg", [&](std::size_t i) { return values[i].geopotential; });
  add("effective_gravity_m_s2", [&](std::size_t i) { return norm(values[i].effective); });
  if (places.normals.empty()) return columns;
  add("slope_deg", [&](std::size_t i) { return slope_degrees(places.normals[i], values[i].effective); });
  add("elevation_m", [&](std::size_t i) { return elevation(values[i], means); });
  return columns;
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

std::vector<double> interleave(std::span<const GravityColumn> columns) {
  const std::size_t rows = columns.front().values.size();
  std::vector<double> table;
  table.reserve(rows * columns.size());
  for (std::size_t i = 0; i < rows; ++i) {
    for (const GravityColumn& c : columns) table.push_back(c.values[i]);
  }
  return table;
}

Json error_json(const AchievedError& error, double tolerance) {
  return {{"tolerance", tolerance},
          {"sample", error.points},
          {"largest", error.largest},
          {"rms", error.rms},
          {"largest_of_potential", error.largest_of_potential}};
}

}  // namespace astrolith
