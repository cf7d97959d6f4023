#include "estimation/shape/field_derivatives.h"

#include <array>

namespace astrolith {
namespace {

MetaballSums<double> sums_at(const MetaballModel& model, const MetaballParameters<double>& parameters,
                             std::span<const std::int32_t> neighbours, const Vec3d& p) {
  MetaballSums<double> sums;
  for (const std::int32_t i : neighbours) {
    const Sphere& s = model.spheres[static_cast<std::size_t>(i)];
    accumulate_metaball(parameters, MetaballSphere<double>{s.center, 1.0 / (s.radius * s.radius)}, p, sums);
  }
  return sums;
}

// What one sphere contributes at a point: weight w and the geometry of k and u.
struct Contribution {
  double weight;                  // w_i; 0 beyond the support
  double inverse_radius_squared;  // 1 / r_i^2
  double q;                       // |p - c_i|^2 / r_i^2
  Vec3d u;                        // (p - c_i) / r_i^2
};

Contribution contribution(const MetaballModel& model, const MetaballParameters<double>& parameters,
                          std::int32_t index, const Vec3d& p, double inverse_total) {
  const Sphere& s = model.spheres[static_cast<std::size_t>(index)];
  const Vec3d d = p - s.center;
  const double v = 1.0 / (s.radius * s.radius);
  const double q = squared_norm(d) * v;
  const double weight =
      q < parameters.cutoff_squared ? std::exp(model.sharpness * (1.0 - q)) * inverse_total : 0.0;
  return {weight, v, q, d * v};
}

}  // namespace

double distance_with_derivatives(const MetaballModel& model, const MetaballParameters<double>& parameters,
                                 std::span<const std::int32_t> neighbours, const Vec3d& p,
                                 std::span<SphereDerivatives> by_sphere, double* by_log_sharpness) {
  const MetaballSums<double> sums = sums_at(model, parameters, neighbours, p);
  const double s = metaball_distance(parameters, sums).distance;
  if (by_sphere.empty()) return s;

  const double kappa = model.sharpness;
  const double inverse_total = 1.0 / (sums.kernel + double{kKernelFloor});
  const Vec3d g = sums.weighted * inverse_total;  // G
  const double n2 = 4.0 * squared_norm(g) + parameters.gradient_floor;
  const double n = std::sqrt(n2);
  const double by_lambda = 1.0 / (kappa * n);  // ds/dLambda
  const Vec3d by_g = g * (-4.0 * s / n2);      // ds/dG
  const double by_g_of_g = dot(by_g, g);
  double by_kappa = -s / kappa;
  for (std::size_t j = 0; j < neighbours.size(); ++j) {
    const Contribution c = contribution(model, parameters, neighbours[j], p, inverse_total);
    const double by_g_of_u = dot(by_g, c.u);
    const double by_k = c.weight * (by_lambda + by_g_of_u - by_g_of_g);  // ds/dk_i
    const Vec3d by_center = c.u * (2.0 * kappa * by_k) - by_g * (c.weight * c.inverse_radius_squared);
    by_sphere[j] = {by_center.x, by_center.y, by_center.z,
                    2.0 * kappa * c.q * by_k - 2.0 * c.weight * by_g_of_u};
    by_kappa += (1.0 - c.q) * by_k;
  }
  *by_log_sharpness = kappa * by_kappa;
  return s;
}

double level_with_derivatives(const MetaballModel& model, const MetaballParameters<double>& parameters,
                              std::span<const std::int32_t> neighbours, const Vec3d& p,
                              std::span<SphereDerivatives> by_sphere, double* by_log_sharpness) {
  const MetaballSums<double> sums = sums_at(model, parameters, neighbours, p);
  const double total = sums.kernel + double{kKernelFloor};
  const double level = std::log(total) / model.sharpness;
  if (by_sphere.empty()) return level;

  double by_log_kappa = -level;
  for (std::size_t j = 0; j < neighbours.size(); ++j) {
    const Contribution c = contribution(model, parameters, neighbours[j], p, 1.0 / total);
    by_sphere[j] = {2.0 * c.weight * c.u.x, 2.0 * c.weight * c.u.y, 2.0 * c.weight * c.u.z,
                    2.0 * c.weight * c.q};
    by_log_kappa += (1.0 - c.q) * c.weight;
  }
  *by_log_sharpness = by_log_kappa;
  return level;
}

}  // namespace astrolith
