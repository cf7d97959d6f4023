#include "descriptor/surface/surface_quantity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "descriptor/surface/realism.h"
#include "numerics/cholesky.h"
#include "numerics/portable_double.h"

namespace astrolith {
namespace {

constexpr std::size_t kTerms = 6;
using Row = std::array<double, kTerms>;
using Square = std::array<double, kTerms * kTerms>;

// The normal equations of the least-squares problem: the lower half of the matrix, and the right side.
struct NormalEquations {
  Square matrix{};
  Row right{};

  void add(const Vec3d& p) {
    const Row terms{1.0, p.x, p.y, p.x * p.x, p.x * p.y, p.y * p.y};
    for (std::size_t i = 0; i < kTerms; ++i) {
      for (std::size_t j = 0; j <= i; ++j) matrix[i * kTerms + j] += terms[i] * terms[j];
      right[i] += terms[i] * p.z;
    }
  }
};

// The log of the rms residual over the quadric, divided by the radius.
double log_roughness(const SurfaceDisc& disc) {
  return portable::log(std::max(disc.moments.rms, kNegligibleResidual));
}

// The rms angle between the surface's normals and the quadric's, by chords: degrees.
double normal_spread(const SurfaceDisc& disc) {
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
     .disc_value = log_roughness,
     .words = roughness_words,
     .by_scale = true},
    {.name = "skewness",
     .heading = "skewness",
     .disc_value = [](const SurfaceDisc& disc) { return disc.moments.skewness; },
     .words = skewness_words,
     .has_mean = true},
    {.name = "kurtosis",
     .heading = "kurtosis",
     .disc_value = [](const SurfaceDisc& disc) { return disc.moments.kurtosis; },
     .words = kurtosis_words,
     .by_scale = true},
    {.name = "normals",
     .heading = "spread of normals",
     .disc_value = normal_spread,
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

std::optional<LocalQuadric> fit_quadric(std::span<const Vec3d> points) {
  if (points.size() < kTerms) return std::nullopt;
  NormalEquations equations;
  for (const Vec3d& p : points) equations.add(p);
  constexpr double kLeastPivot = 1e-10;  // of the diagonal element
  if (!factor_cholesky(equations.matrix, kTerms, kLeastPivot)) return std::nullopt;
  solve_cholesky(equations.matrix, kTerms, equations.right);
  return LocalQuadric{equations.right};
}

ResidualMoments residual_moments(std::span<const double> residuals, double negligible) {
  double second = 0.0, third = 0.0, fourth = 0.0;
  for (const double r : residuals) {
    const double square = r * r;
    second += square;
    third += square * r;
    fourth += square * square;
  }
  const auto n = static_cast<double>(residuals.size());
  ResidualMoments moments;
  moments.rms = std::sqrt(second / (n - static_cast<double>(kTerms)));
  if (moments.rms < negligible) return moments;
  const double variance = second / n;
  moments.skewness = third / n / (variance * std::sqrt(variance));
  moments.kurtosis = fourth / n / (variance * variance) - 3.0;
  return moments;
}

std::span<const SurfaceQuantityTraits> surface_quantities() { return kQuantities; }

}  // namespace astrolith
