// The quadric that fits points around a place, and what the points leave over it.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "numerics/vec3.h"

namespace astrolith {

// z = c0 + c1 x + c2 y + c3 x^2 + c4 x y + c5 y^2
struct LocalQuadric {
  std::array<double, 6> c{};

  double height(double x, double y) const {
    return c[0] + x * (c[1] + c[3] * x + c[4] * y) + y * (c[2] + c[5] * y);
  }
  // The unit normal above (x, y), upwards.
  Vec3d normal(double x, double y) const {
    return normalized(Vec3d{-(c[1] + 2.0 * c[3] * x + c[4] * y), -(c[2] + c[4] * x + 2.0 * c[5] * y), 1.0});
  }
};

// The least-squares quadric of (n) points, whose coordinates are of the order of 1. None where the points do
// not determine the six coefficients.
std::optional<LocalQuadric> fit_quadric(std::span<const Vec3d> points);

// The moments of the residuals of n points over their quadric, heights less the quadric's.
struct ResidualMoments {
  double rms = 0.0;       // sqrt(sum r^2 / (n - 6)), the estimate without bias for independent heights
  double skewness = 0.0;  // mean r^3 / (mean r^2)^1.5: bumps on a plain > 0, pits < 0
  double kurtosis = 0.0;  // mean r^4 / (mean r^2)^2 - 3: 0 for Gaussian heights
};

// The moments for n > 6 points. Skewness and kurtosis are 0 where the rms is below `negligible`.
ResidualMoments residual_moments(std::span<const double> residuals, double negligible);

}  // namespace astrolith
