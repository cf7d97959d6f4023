// What is measured at the places of a surface, one row each: measure, names, weight in the verdict, and
// words. Reports, JSON and tables read the rows; a new quantity that is measured within radii is its name and
// its row.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "descriptor/surface/local_quadric.h"

namespace astrolith {

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
  double (*of_disc)(const SurfaceDisc&) = nullptr;
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
inline const SurfaceQuantityTraits& traits_of(SurfaceQuantity quantity) {
  return surface_quantities()[static_cast<std::size_t>(quantity)];
}
inline const char* name_of(SurfaceQuantity quantity) { return traits_of(quantity).name; }

}  // namespace astrolith
