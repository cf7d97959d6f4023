// What gravity and rotation make of a point: geopotential, slope, elevation. SI units throughout: metres,
// seconds, kilograms. docs/gravity.md has the equations.
#pragma once

#include <span>
#include <vector>

#include "gravity/polyhedron_gravity.h"

namespace astrolith {

constexpr double kGravitationalConstant = 6.67430e-11;  // m^3 / (kg s^2), CODATA 2018

// A body that turns about an axis through its centre of mass.
struct Rotation {
  Vec3d center;         // m
  Vec3d axis{0, 0, 1};  // unit vector
  double rate = 0.0;    // rad / s; 0 = at rest
};

struct PointGravity {
  double potential = 0.0;     // -U, J / kg
  Vec3d acceleration;         // grad U, m / s^2
  double geopotential = 0.0;  // -U - w^2 s^2 / 2, J / kg; s is the distance from the axis
  Vec3d effective;            // grad U + w^2 s, m / s^2
};

// From attractions for G times density = 1 in units of `metres_per_unit`, at points in metres.
std::vector<PointGravity> point_gravity(std::span<const Vec3d> points,
                                        std::span<const Attraction> attractions, double density,
                                        double metres_per_unit, const Rotation& rotation);

// The angle in degrees between the outward normal and the direction against effective gravity, in [0, 180];
// 90 where one of both vanishes.
double slope_degrees(const Vec3d& normal, const Vec3d& effective);

// Means over the surface, each point with its area as weight.
struct SurfaceMeans {
  double potential = 0.0, geopotential = 0.0;  // J / kg
  double effective = 0.0;                      // m / s^2
};
SurfaceMeans surface_means(std::span<const PointGravity> values, std::span<const double> areas);

// (geopotential - its mean) / mean effective gravity, m; 0 where the latter vanishes.
inline double elevation(const PointGravity& value, const SurfaceMeans& means) {
  return means.effective > 0.0 ? (value.geopotential - means.geopotential) / means.effective : 0.0;
}

}  // namespace astrolith
