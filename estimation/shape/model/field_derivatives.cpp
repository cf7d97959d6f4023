#include "estimation/shape/model/field_derivatives.h"

#include <array>

#include "estimation/shape/model/compact_kernel_derivatives_internal.h"
#include "estimation/shape/model/signed_terms_internal.h"

namespace astrolith {
namespace {

// Sums over the neighbours as synthesis takes them (synthesis/body/metaballs.h). If `terms` is not empty, it
// receives the terms of every sphere: u_i (3), then exp k_i, which is 0 beyond the support.
MetaballTotals<double> totals_at(const MetaballModel& model, const ModelEvaluation& parameters,
                                 std::span<const std::int32_t> neighbours, const Vec3d& p,
                                 std::span<SphereDerivatives> terms) {
  MetaballTotals<double> totals;
  for (std::size_t j = 0; j < neighbours.size(); ++j) {
    const ModelSphere& s = model.spheres[static_cast<std::size_t>(neighbours[j])];
    MetaballSums<double>& sums = s.subtractive ? totals.subtracted : totals.added;
    const double v = 1.0 / (s.radius * s.radius);
    const Vec3d d = p - s.center;
    const double q = squared_norm(d) * v;
    const Vec3d u = d * v;
    const double kernel =
        q < parameters.cutoff_squared
            ? std::exp(std::min(parameters.m_a - parameters.m_b * q, double{kLargestExponent}))
            : 0.0;
    sums.kernel += kernel;
    sums.weighted += u * kernel;
    if (!terms.empty()) terms[j] = {u.x, u.y, u.z, kernel};
  }
  return totals;
}

}  // namespace

double distance_with_derivatives(const MetaballModel& model, const ModelEvaluation& parameters,
                                 std::span<const std::int32_t> neighbours, const Vec3d& p,
                                 std::span<SphereDerivatives> by_sphere, double* by_log_sharpness) {
  if (model.kernel != Kernel::kGaussian) {
    return compact_distance(model, parameters, neighbours, p, by_sphere, by_log_sharpness);
  }
  const MetaballTotals<double> totals = totals_at(model, parameters, neighbours, p, by_sphere);
  const double s = metaball_distance(parameters, totals.net()).distance;
  if (by_sphere.empty()) return s;

  const double kappa = model.sharpness;
  const SignedTerms terms(totals);
  const Vec3d g = terms.weighted_mean();  // G
  const double n2 = 4.0 * squared_norm(g) + parameters.gradient_floor;
  const double n = std::sqrt(n2);
  const double by_lambda = 1.0 / (kappa * n);  // ds/dLambda
  const Vec3d by_g = g * (-4.0 * s / n2);      // ds/dG
  double by_kappa = -s / kappa;
  for (std::size_t j = 0; j < neighbours.size(); ++j) {
    const ModelSphere& sphere = model.spheres[static_cast<std::size_t>(neighbours[j])];
    const KindTerms& kind = terms.of(sphere.subtractive);
    const double radius = sphere.radius;
    const Vec3d u{by_sphere[j][0], by_sphere[j][1], by_sphere[j][2]};
    const double weight = by_sphere[j][3] * kind.weight;
    const double q = squared_norm(u) * radius * radius;
    const double by_g_of_u = dot(by_g, u);
    const double by_k = weight * (by_lambda + by_g_of_u - dot(by_g, kind.mean));  // ds/dk_i
    const Vec3d by_center = u * (2.0 * kappa * by_k) - by_g * (weight / (radius * radius));
    by_sphere[j] = {by_center.x, by_center.y, by_center.z, 2.0 * kappa * q * by_k - 2.0 * weight * by_g_of_u};
    by_kappa += (1.0 - q) * by_k;
  }
  *by_log_sharpness = kappa * by_kappa;
  return s;
}

double level_with_derivatives(const MetaballModel& model, const ModelEvaluation& parameters,
                              std::span<const std::int32_t> neighbours, const Vec3d& p,
                              std::span<SphereDerivatives> by_sphere, double* by_log_sharpness) {
  if (model.kernel != Kernel::kGaussian) {
    return compact_level(model, parameters, neighbours, p, by_sphere, by_log_sharpness);
  }
  const MetaballTotals<double> totals = totals_at(model, parameters, neighbours, p, by_sphere);
  const double level = level_of(model, totals.net().kernel);
  if (by_sphere.empty()) return level;

  const SignedTerms terms(totals);
  double by_log_kappa = -level;
  for (std::size_t j = 0; j < neighbours.size(); ++j) {
    const ModelSphere& sphere = model.spheres[static_cast<std::size_t>(neighbours[j])];
    const Vec3d u{by_sphere[j][0], by_sphere[j][1], by_sphere[j][2]};
    const double weight = by_sphere[j][3] * terms.of(sphere.subtractive).weight;
    const double q = squared_norm(u) * sphere.radius * sphere.radius;
    by_sphere[j] = {2.0 * weight * u.x, 2.0 * weight * u.y, 2.0 * weight * u.z, 2.0 * weight * q};
    by_log_kappa += (1.0 - q) * weight;
  }
  *by_log_sharpness = by_log_kappa;
  return level;
}

}  // namespace astrolith
