#include "descriptor/local_features.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "numerics/portable_angles.h"

namespace astrolith {
namespace {

// The bin of a number in [0, 1] among equal bins.
std::int32_t bin_index(double fraction, int bins) {
  return std::clamp(static_cast<std::int32_t>(std::floor(fraction * bins)), 0, bins - 1);
}

}  // namespace

double normal_perturbation(const Vec3d& point, const Vec3d& unit_normal, const Vec3d& center) {
  const Vec3d position = point - center;
  if (squared_norm(position) == 0) return std::numbers::pi / 2;
  return portable::atan2(norm(cross(position, unit_normal)), dot(position, unit_normal));
}

double bounded_curvature(double scale_free_curvature) {
  return scale_free_curvature / (1 + std::fabs(scale_free_curvature));
}

PointSpread point_spread(std::span<const Vec3d> points) {
  PointSpread spread;
  if (points.empty()) return spread;
  const double share = 1 / static_cast<double>(points.size());
  for (const Vec3d& p : points) spread.center += p;
  spread.center *= share;
  for (const Vec3d& p : points) spread.mean_square += squared_norm(p - spread.center);
  spread.mean_square *= share;
  return spread;
}

std::vector<std::int32_t> local_codes(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                                      std::span<const double> curvatures, int bins) {
  const PointSpread spread = point_spread(points);
  std::vector<std::int32_t> codes(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double eta = normal_perturbation(points[i], normals[i], spread.center);
    const double kappa = bounded_curvature(curvatures[i] * spread.mean_square);
    codes[i] = bin_index(eta / std::numbers::pi, bins) * bins + bin_index((kappa + 1) / 2, bins);
  }
  return codes;
}

}  // namespace astrolith
