#include "estimation/shape/model/compact_kernel_derivatives_internal.h"

#include <cmath>

namespace astrolith {
namespace {

// The terms of one sphere at a point, in the symbols of the header.
struct Term {
  Vec3d u;
  double q, inverse_square;     // q, and 1 / r^2
  KernelDerivatives<double> k;  // K, D and C; all 0 beyond the support
};

Term term_of(const MetaballModel& model, const ModelEvaluation& parameters, std::int32_t sphere,
             const Vec3d& p) {
  const Sphere& s = model.spheres[static_cast<std::size_t>(sphere)];
  const double v = 1.0 / (s.radius * s.radius);
  const Vec3d d = p - s.center;
  const double q = squared_norm(d) * v;
  const bool reached = q < parameters.cutoff_squared;
  return {d * v, q, v,
          reached ? kernel_value(parameters.compact_kernel, q) : KernelDerivatives<double>{0.0, 0.0, 0.0}};
}

struct Sums {
  double level = double{kKernelFloor} - 1.0;  // L
  Vec3d gradient;                             // g
};

Sums sums_at(const MetaballModel& model, const ModelEvaluation& parameters,
             std::span<const std::int32_t> neighbours, const Vec3d& p) {
  Sums sums;
  for (const std::int32_t i : neighbours) {
    const Term t = term_of(model, parameters, i, p);
    sums.level += t.k.value;
    sums.gradient += t.u * (-2.0 * t.k.slope);
  }
  return sums;
}

double value_by_tension(const ModelEvaluation& parameters, const Term& t) {
  if (t.k.value == 0.0) return 0.0;
  const CompactKernelTension& by = parameters.tension;
  return by.log_height * t.k.value - by.log_scale * t.k.slope * t.q -
         parameters.compact_kernel.height * by.low;
}

// Derivatives of by_level L + by_gradient . g by every sphere and by the logarithm of the tension.
void differentiate(const MetaballModel& model, const ModelEvaluation& parameters,
                   std::span<const std::int32_t> neighbours, const Vec3d& p, double by_level,
                   const Vec3d& by_gradient, std::span<SphereDerivatives> by_sphere,
                   double* by_log_sharpness) {
  const CompactKernelTension& by = parameters.tension;
  double by_tension = 0.0;
  for (std::size_t j = 0; j < neighbours.size(); ++j) {
    const Term t = term_of(model, parameters, neighbours[j], p);
    const double d = t.k.slope, c = t.k.curvature, along = dot(by_gradient, t.u);
    const Vec3d by_center =
        t.u * (2.0 * d * by_level - 4.0 * c * along) + by_gradient * (2.0 * d * t.inverse_square);
    by_sphere[j] = {by_center.x, by_center.y, by_center.z,
                    2.0 * d * t.q * by_level + 4.0 * (d - c * t.q) * along};
    const double slope_by_tension = (by.log_height + by.log_scale) * d - by.log_scale * c * t.q;
    by_tension += by_level * value_by_tension(parameters, t) - 2.0 * slope_by_tension * along;
  }
  *by_log_sharpness = model.sharpness * by_tension;
}

}  // namespace

double compact_distance(const MetaballModel& model, const ModelEvaluation& parameters,
                        std::span<const std::int32_t> neighbours, const Vec3d& p,
                        std::span<SphereDerivatives> by_sphere, double* by_log_sharpness) {
  const Sums sums = sums_at(model, parameters, neighbours, p);
  const double n2 = squared_norm(sums.gradient) + parameters.gradient_floor;
  const double n = std::sqrt(n2), s = sums.level / n;
  if (!by_sphere.empty()) {
    differentiate(model, parameters, neighbours, p, 1.0 / n, sums.gradient * (-s / n2), by_sphere,
                  by_log_sharpness);
  }
  return s;
}

double compact_level(const MetaballModel& model, const ModelEvaluation& parameters,
                     std::span<const std::int32_t> neighbours, const Vec3d& p,
                     std::span<SphereDerivatives> by_sphere, double* by_log_sharpness) {
  const Sums sums = sums_at(model, parameters, neighbours, p);
  if (!by_sphere.empty())
    differentiate(model, parameters, neighbours, p, 1.0, {}, by_sphere, by_log_sharpness);
  return sums.level;
}

}  // namespace astrolith
