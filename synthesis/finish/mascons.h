// The gravity of a body of uniform density: its spheres as mass concentrations, each with its share of the
// body's volume, so that what several spheres overlap is counted once.
#pragma once

#include <span>
#include <vector>

#include "synthesis/field/implicit_field.h"

namespace astrolith {

// A homogeneous ball.
struct Mascon {
  Vec3d center;
  double radius = 0.0;
};

// How a body turns and how dense it is.
struct BodyMotion {
  double density = 2000.0;      // kg / m^3, > 0
  double rotation_hours = 0.0;  // about +z through the centre of mass; 0 = at rest
};

// The points of a lattice that lie inside `field` are shared out among the spheres: to the one whose centre
// is nearest in its own radii. A sphere's mascon has the volume and the centroid of its points; spheres
// without a point have none. Throws InputError when no point is inside.
std::vector<Mascon> mascons_of(const ImplicitField& field, std::span<const Sphere> spheres);

// up[i]: the unit vector against gravity and centrifugal force at a point; the zero vector where they cancel.
// The same bits for any thread count and vector width.
std::vector<Vec3d> vertical_directions(std::span<const Mascon> mascons, const BodyMotion& motion,
                                       std::span<const Vec3d> points);

}  // namespace astrolith
