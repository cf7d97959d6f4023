// The tables and pictures that gravity writes.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "apps/gravity/gravity_body.h"
#include "apps/program.h"
#include "gravity/surface_gravity.h"

namespace astrolith {

// The places where gravity was computed. Points of a file have neither normals nor areas.
struct GravityPlaces {
  std::vector<Vec3d> points;   // in the body's unit
  std::vector<Vec3d> normals;  // outward unit vectors, or empty
  std::vector<double> areas;   // weights of means, or empty
};

// One column of the table.
struct GravityColumn {
  std::string name;
  std::vector<double> values;
};

// x, y and z in the body's unit, then J/kg, m/s2, degrees and metres. Slopes and elevations where there are
// normals.
std::vector<GravityColumn> gravity_columns(const GravityPlaces& places, std::span<const PointGravity> values,
                                           const SurfaceMeans& means);

// .csv: a line of names and then numbers that read back as the same doubles; .npy: (points x columns)
// float64; .ply: the mesh with the columns behind z as properties of its vertices.
void write_gravity(const std::vector<GravityColumn>& columns, const GravityBody& body,
                   const std::filesystem::path& file, const std::string& tool);

// The mesh in the colours of one column, which has a value for each vertex, or for each facet.
void write_gravity_preview(const Program& program, const GravityBody& body, const GravityColumn& column,
                           const std::filesystem::path& file);

}  // namespace astrolith
