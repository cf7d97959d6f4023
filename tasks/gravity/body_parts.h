// Parts of a body that have densities of their own: a lobe, a boulder, a core, a cavity.
#pragma once

#include <string>
#include <vector>

#include "gravity/body_mass.h"
#include "gravity/polyhedron_gravity.h"
#include "numerics/progress.h"
#include "tasks/gravity/gravity_body.h"

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

}  // namespace astrolith
