// Gravity at many places as columns of numbers and as ranges.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "gravity/surface_gravity.h"

namespace astrolith {

// The places where gravity was computed. Points of a file have neither normals nor areas.
struct GravityPlaces {
  std::vector<Vec3d> points;   // in the body's unit
  std::vector<Vec3d> normals;  // outward unit vectors, or empty
  std::vector<double> areas;   // weights of means, or empty
  std::string kind = "points";
};

// One column of the table.
struct GravityColumn {
  std::string name;
  std::vector<double> values;
};

// The centres of all facets, and all vertices with a third of the area of their facets. Their kinds are
// "facets" and "vertices".
GravityPlaces facet_places(const TriangleMesh& mesh);
GravityPlaces vertex_places(const TriangleMesh& mesh);

std::vector<Vec3d> in_metres(std::span<const Vec3d> points, double metres);

// x, y and z in the body's unit, then J/kg, m/s2, degrees and metres. Slopes and elevations where there are
// normals.
std::vector<GravityColumn> gravity_columns(const GravityPlaces& places, std::span<const PointGravity> values,
                                           const SurfaceMeans& means);

// Means over the surface and the ranges of potential, geopotential, gravity, slope, elevation and escape
// speed.
nlohmann::ordered_json surface_json(const GravityPlaces& places, std::span<const PointGravity> values,
                                    const SurfaceMeans& means);

// The columns side by side, row after row.
std::vector<double> interleave(std::span<const GravityColumn> columns);

nlohmann::ordered_json error_json(const AchievedError& error, double tolerance);

}  // namespace astrolith
