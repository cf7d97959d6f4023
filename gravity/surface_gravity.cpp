#include "gravity/surface_gravity.h"

#include <cmath>
#include <numbers>

#include "numerics/portable_angles.h"

namespace astrolith {

std::vector<PointGravity> point_gravity(std::span<const Vec3d> points,
                                        std::span<const Attraction> attractions, double density,
                                        double metres_per_unit, const Rotation& rotation) {
  const double strength = kGravitationalConstant * density;
  const double square = rotation.rate * rotation.rate;
  std::vector<PointGravity> values(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3d from_center = points[i] - rotation.center;
    const Vec3d from_axis = from_center - dot(from_center, rotation.axis) * rotation.axis;
    PointGravity& value = values[i];
    value.potential = -strength * metres_per_unit * metres_per_unit * attractions[i].potential;
    value.acceleration = strength * metres_per_unit * attractions[i].acceleration;
    value.geopotential = value.potential - 0.5 * square * squared_norm(from_axis);
    value.effective = value.acceleration + square * from_axis;
  }
  return values;
}

double slope_degrees(const Vec3d& normal, const Vec3d& effective) {
  const double across = norm(cross(normal, effective)), along = -dot(normal, effective);
  if (across == 0.0 && along == 0.0) return 90.0;
  return portable::atan2(across, along) * (180.0 / std::numbers::pi);
}

SurfaceMeans surface_means(std::span<const PointGravity> values, std::span<const double> areas) {
  SurfaceMeans sums;
  double area = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    sums.potential += areas[i] * values[i].potential;
    sums.geopotential += areas[i] * values[i].geopotential;
    sums.effective += areas[i] * norm(values[i].effective);
    area += areas[i];
  }
  if (area > 0.0) {
    for (double* sum : {&sums.potential, &sums.geopotential, &sums.effective}) *sum /= area;
  }
  return sums;
}

}  // namespace astrolith
