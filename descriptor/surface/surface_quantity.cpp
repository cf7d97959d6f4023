#include "descriptor/surface/surface_quantity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "descriptor/surface/realism.h"
#include "numerics/portable_double.h"

namespace astrolith {
namespace {

// The log of the rms residual over the quadric, divided by the radius.
double log_roughness(const SurfaceDisc& disc) {
  return portable::log(std::max(disc.moments.rms, kNegligibleResidual));
}

// The rms angle between the surface's normals and the quadric's, by chords: degrees.
double spread_of_normals(const SurfaceDisc& disc) {
  double squares = 0.0;
  for (std::size_t k = 0; k < disc.heights.size(); ++k) {
    const Vec3d& p = disc.heights[k];
    squares += squared_norm(disc.normals[k] - disc.quadric.normal(p.x, p.y));
  }
  return 180.0 / std::numbers::pi * std::sqrt(squares / static_cast<double>(disc.heights.size()));
}

std::string roughness_words(const StatisticComparison& c) {
  const double off = c.middle_b - c.middle_a;
  if (std::fabs(off) > 0.25 * c.spread_a) return off < 0.0 ? "too smooth" : "too rough";
  return c.spread_b < c.spread_a ? "too much alike from place to place" : "too unlike from place to place";
}

std::string skewness_words(const StatisticComparison& c) {
  constexpr double kClear = 0.05;  // a mean skewness beyond this shows boulders or craters
  const double a = c.middle_a, b = c.middle_b;
  if (b < a && a > kClear) return b < a / 3.0 ? "no boulders" : "too few boulders";
  if (b > a && a < -kClear) return b > a / 3.0 ? "no craters" : "too few craters";
  if (b > a && b > kClear) return "too many boulders";
  if (b < a && b < -kClear) return "too many craters";
  return c.spread_b < c.spread_a ? "boulders and craters stand out too little"
                                 : "boulders and craters stand out too much";
}

std::string kurtosis_words(const StatisticComparison& c) {
  return c.middle_b < c.middle_a ? "too few single peaks or pits" : "too many single peaks or pits";
}

std::string normals_words(const StatisticComparison& c) {
  return c.middle_b < c.middle_a ? "slopes too gentle" : "slopes too steep";
}

std::string bend_words(const StatisticComparison&) { return "flat facets of a coarser mesh"; }

std::string slope_words(const StatisticComparison& c) {
  return fmt::format("{}: median slope {:.3g} instead of {:.3g} degrees",
                     c.middle_b < c.middle_a ? "too flat" : "too steep", c.middle_b, c.middle_a);
}

constexpr SurfaceQuantityTraits kQuantities[] = {
    {.name = "roughness",
     .heading = "log roughness",
     .of_disc = log_roughness,
     .words = roughness_words,
     .by_scale = true},
    {.name = "skewness",
     .heading = "skewness",
     .of_disc = [](const SurfaceDisc& disc) { return disc.moments.skewness; },
     .words = skewness_words,
     .has_mean = true},
    {.name = "kurtosis",
     .heading = "kurtosis",
     .of_disc = [](const SurfaceDisc& disc) { return disc.moments.kurtosis; },
     .words = kurtosis_words,
     .by_scale = true},
    {.name = "normals",
     .heading = "spread of normals",
     .of_disc = spread_of_normals,
     .words = normals_words,
     .by_scale = true,
     .follows = SurfaceQuantity::roughness},
    {.name = "bend",
     .heading = "bend between facets, degrees",
     .list = "bends",
     .words = bend_words,
     .only_flat = true},
    // A slope follows the body's shape, which one draw does not share with another.
    {.name = "slope",
     .heading = "slope, degrees",
     .list = "slopes",
     .words = slope_words,
     .counts_in_distance = false},
};

}  // namespace

std::span<const SurfaceQuantityTraits> surface_quantities() { return kQuantities; }

}  // namespace astrolith
