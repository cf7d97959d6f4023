// What is measured at the places of a surface, one row each: measure, names, weight in the verdict, and
// words. Reports, JSON and tables read the rows; a new quantity that is measured within radii is its name and
// its row.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

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

enum class SurfaceQuantity {
  roughness,
  skewness,
  kurtosis,
  normals,
  bend,  // between the mesh's own facets within .5 edges: shows facets that are too large
  slope  // between the normal and the vertical of gravity and rotation
};

// The surface within a radius around a place. Lengths are in units of the radius.
struct SurfaceDisc {
  std::vector<Vec3d> heights;  // in the frame of the mean normal
  std::vector<Vec3d> normals;  // in that frame
  LocalQuadric quadric;        // that fits the heights
  std::vector<double> residuals;
  ResidualMoments moments;
};
// Residuals below this share of the radius are rounding, and have no shape.
inline constexpr double kNegligibleResidual = 1e-9;

struct StatisticComparison;

struct SurfaceQuantityTraits {
  const char* name;     // as in JSON and in tables
  const char* heading;  // of a plot, with the unit
  // What a disc has of it; null for what is not measured within radii, whose distribution in JSON is `list`.
  double (*disc_value)(const SurfaceDisc&) = nullptr;
  const char* list = nullptr;
  // What is said of a second surface that differs. Differences that `follows` shows need no words.
  std::string (*words)(const StatisticComparison&);
  bool has_mean = false;  // the middle of its values is their mean, not their median
  bool counts_in_distance = true;
  bool only_flat = false;  // only what is flatter than all but a few places of the first surface counts
  bool by_scale = false;   // the words go with a range of scales
  std::optional<SurfaceQuantity> follows = std::nullopt;
};

std::span<const SurfaceQuantityTraits> surface_quantities();  // in the order of SurfaceQuantity
inline const SurfaceQuantityTraits& quantity_traits(SurfaceQuantity quantity) {
  return surface_quantities()[static_cast<std::size_t>(quantity)];
}
inline const char* quantity_name(SurfaceQuantity quantity) { return quantity_traits(quantity).name; }

}  // namespace astrolith
