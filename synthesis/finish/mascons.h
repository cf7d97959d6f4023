// The gravity of a body of uniform density. Each of its spheres is a mass concentration (mascon) with its
// share of the volume of the body, so that volume in which spheres overlap is counted once.
#pragma once

#include <span>
#include <vector>

#include "synthesis/field/implicit_field.h"

namespace astrolith {

// A homogeneous ball, in length units of the recipe.
struct Mascon {
  Vec3d center;
  double radius = 0.0;
};

// The density and the rotation of a body.
struct BodyMotion {
  double density = 2000.0;      // kg / m^3, > 0
  double rotation_hours = 0.0;  // period about +z through the centre of mass; 0 = at rest
};

// The mascons of a body. Points of a lattice that lie inside `field` are assigned to the sphere whose centre
// is nearest, measured in radii of that sphere. The mascon of a sphere has the volume and the centroid of its
// points. Spheres without points have no mascon. Throws InputError when no point is inside.
std::vector<Mascon> mascons_of(const ImplicitField& field, std::span<const Sphere> spheres);

// About the processor seconds that mascons_of() takes, from two of its 64 planes.
double seconds_of_mascons(const ImplicitField& field, std::span<const Sphere> spheres);

// up[i] is the unit vector against gravity and centrifugal force at points[i], or the zero vector where the
// two cancel. The bits are the same for any number of threads and any vector width.
std::vector<Vec3d> vertical_directions(std::span<const Mascon> mascons, const BodyMotion& motion,
                                       std::span<const Vec3d> points);

}  // namespace astrolith
