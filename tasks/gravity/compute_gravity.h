// The gravity of a body of uniform density that turns, as `gravity` and the Python package compute it.
// Parts of the body may have densities of their own: a lobe, a boulder, a core, a cavity.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "gravity/body_mass.h"
#include "gravity/polyhedron_gravity.h"
#include "numerics/progress.h"
#include "tasks/gravity/gravity_body.h"
#include "tasks/gravity/gravity_table.h"

namespace astrolith {

struct BodyPart {
  std::string name;
  GravityBody body;      // in the unit of the whole
  double density = 0.0;  // kg/m3
  double share = 0.0;    // (density - that of the whole) / that of the whole
  BodyMass mass;         // for density 1
};

// Mass and moments of the whole with its parts, as multiples of the density of the whole: the volume is that
// of a homogeneous body of equal mass. Throws InputError where parts leave no mass.
BodyMass with_parts(const BodyMass& whole, const std::vector<BodyPart>& parts);

// Adds the attraction of the parts' surplus to that of the homogeneous whole at the points. Each part is
// computed within the tolerance, or exactly.
void add_parts(const std::vector<BodyPart>& parts, const std::vector<Vec3d>& points, double tolerance,
               bool exact, const Progress& progress, std::vector<Attraction>& attractions);

struct GravityOptions {
  double density = 0.0;           // kg / m^3, above 0
  double period = 0.0;            // of rotation, hours; 0: the body is at rest
  Vec3d axis{0, 0, 1};            // of rotation, a unit vector
  double tolerance = 1e-7;        // bound of the relative error of each acceleration, 1e-12 to 0.1
  bool exact = false;             // sums over all facets instead, as far as these are exact
  int sample = 100;               // places that are also computed exactly, to state the error achieved
  std::uint64_t seed = 1;         // chooses them
  int degree = 4;                 // of the harmonics, 0 to kMostDegree
  double radius = 0.0;            // reference radius in the body's unit; 0: the farthest vertex
  std::vector<BodyPart> parts{};  // of other densities
};

// The check takes an assertion in the move constructor of nlohmann's JSON for an exception.
// NOLINTNEXTLINE(bugprone-exception-escape)
struct ComputedGravity {
  std::vector<GravityColumn> columns;
  // Unit, density and period, the body's mass and moments, its harmonics, and the ranges of all columns.
  nlohmann::ordered_json figures;
};

// The stages are "tree", "gravity", "check", "parts" and "harmonics". Throws InputError for a body without
// area, and WorkError when progress asks to stop.
ComputedGravity compute_gravity(const GravityBody& body, const GravityPlaces& places,
                                const GravityOptions& options, const StageProgress& progress);

}  // namespace astrolith
