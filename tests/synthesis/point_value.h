// The value of metaballs at a single point.
#pragma once

#include "synthesis/body/metaball_body.h"

namespace astrolith::testing {

struct PointValue {
  float distance, gx, gy, gz;
};

inline PointValue evaluate_one(const PreparedMetaballs& metaballs, const Vec3d& p) {
  const float x = static_cast<float>(p.x), y = static_cast<float>(p.y), z = static_cast<float>(p.z);
  PointValue v{};
  evaluate_metaballs(metaballs, 1, &x, &y, &z, &v.distance, &v.gx, &v.gy, &v.gz);
  return v;
}

// The gradient of the distance by central differences of steps h.
inline Vec3d measured_gradient(const PreparedMetaballs& metaballs, const Vec3d& p, double h) {
  const auto slope = [&](const Vec3d& d) {
    return (double{evaluate_one(metaballs, p + d).distance} -
            double{evaluate_one(metaballs, p - d).distance}) /
           (2 * h);
  };
  return {slope({h, 0, 0}), slope({0, h, 0}), slope({0, 0, h})};
}

}  // namespace astrolith::testing
