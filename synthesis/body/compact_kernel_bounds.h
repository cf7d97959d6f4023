// Bounds of metaballs over a box for kernels other than the Gaussian, for CPU and GPU. A kernel and its slope
// both fall with the distance from the centre. Their values at the nearest and the farthest point of a box
// are therefore bounds.
//
// With w_i = (K_i / M)^(m-1), grad M = sum_i w_i grad K_i. Since sum_i (K_i / M)^m = 1, no w_i exceeds 1. In
// a body with subtractive metaballs this holds for P^(1/m) and for (1 + N)^(1/m), whose quotient is M
// (metaballs.h):
//
//   |grad M| <= (|grad P^(1/m)| + M |grad (1 + N)^(1/m)|) / (1 + N)^(1/m).
#pragma once

#include "synthesis/body/metaball_bounds.h"

namespace astrolith {

inline constexpr double kKernelRounding = 4e-6;  // float error of a kernel, over its height at the centre

ASTROLITH_HD inline CompactKernel<double> kernel_in_double(const MetaballParameters<float>& body) {
  const CompactKernel<float>& k = body.compact_kernel;
  return {k.kernel, double{k.scale}, double{k.low}, double{k.height}};
}

// K^m for a value K that includes float rounding; saturated like the float evaluation.
ASTROLITH_HD inline double kernel_to_power(double k, double m) {
  return k > 0.0 ? std::min(portable::pow(k, m), portable::exp(double{kLargestExponent})) : 0.0;
}

// Bounds K_i^m of all spheres that reach the box. `kernels` needs room for all spheres.
ASTROLITH_HD inline BodyIntervals bound_compact_kernels(const MetaballParameters<float>& body,
                                                        const MetaballList& spheres, const Box& box,
                                                        KernelInterval* kernels) {
  const CompactKernel<double> compact_kernel = kernel_in_double(body);
  const double rounding = kKernelRounding * compact_kernel.height, m = double{body.m},
               cutoff = double{body.cutoff_squared};
  return bound_kernels(spheres, kernels, [&](const MetaballSphere<float>& s, KernelInterval& kernel) {
    const Interval q = squared_radii(s, box);
    if (q.low >= cutoff) return false;
    const bool inside = q.high < cutoff;
    const KernelDerivatives<double> nearest = kernel_value(compact_kernel, q.low);
    const KernelDerivatives<double> farthest = kernel_value(compact_kernel, inside ? q.high : cutoff);
    const double power_max = kernel_to_power(std::max(nearest.value, 0.0) + rounding, m);
    const double power_min = inside ? kernel_to_power(farthest.value - rounding, m) : 0.0;
    const double slope_max = nearest.slope * (1.0 + kKernelRounding) + rounding * compact_kernel.scale;
    const double radii = std::sqrt(std::min(q.high, cutoff) * inverse_square(s));
    kernel = {
        &s,       power_min, power_max, 2.0 * slope_max * radii, inside ? farthest.slope * (1.0 - 1e-5) : 0.0,
        slope_max};
    return true;
  });
}

// The weight w_i from K_i^m and the sum of all K^m.
ASTROLITH_HD inline double compact_weight(double power, double sum, double m) {
  return portable::pow(std::min(1.0, power / sum), 1.0 - 1.0 / m);
}

// An upper bound of |grad (sum K^m)^(1/m)| over the spheres of one kind, where the sum of K^m is at least
// `sum`. It is the lesser of two bounds: the sum of the weighted gradients, and Hoelder's inequality.
ASTROLITH_HD inline double largest_compact_gradient(const KernelIntervals& bounds, double sum, double m) {
  double weighted = 0.0, powers = 0.0, steepest = 0.0;
  for (std::uint32_t i = 0; i < bounds.count; ++i) {
    steepest = std::max(steepest, bounds.kernels[i].gradient_max);
  }
  if (steepest == 0.0) return 0.0;
  for (std::uint32_t i = 0; i < bounds.count; ++i) {
    const KernelInterval& k = bounds.kernels[i];
    weighted += compact_weight(k.max, std::max(sum, bounds.sum_min - k.min + k.max), m) * k.gradient_max;
    powers += portable::pow(k.gradient_max / steepest, m);
  }
  return std::min(weighted, steepest * portable::pow(powers, 1.0 / m)) * (1.0 + 3.0 * kDistanceSlack);
}

// An upper bound of |grad M| where the sum of K^m over the spheres that add is at least `sum`, and M is at
// most `largest`.
ASTROLITH_HD inline double largest_net_gradient(const BodyIntervals& bounds, double sum, double largest,
                                                double m) {
  const double added_gradient = largest_compact_gradient(bounds.added, sum, m);
  if (!bounds.subtractive()) return added_gradient;
  const double subtracted_gradient =
      largest_compact_gradient(bounds.subtracted, bounds.subtracted.sum_min, m);
  return (added_gradient + largest * subtracted_gradient) /
         portable::pow(bounds.subtracted.sum_min, 1.0 / m) * (1.0 + kDistanceSlack);
}

// bound_gaussian_body() with M(p) - 1 in the place of L, and |grad M| in the place of |grad L|.
ASTROLITH_HD inline MetaballInterval bound_compact_body(const MetaballParameters<float>& body,
                                                        const MetaballList& spheres, const Box& box,
                                                        double height, KernelInterval* scratch) {
  const double m = double{body.m};
  const BodyIntervals bounds = bound_compact_kernels(body, spheres, box, scratch);
  const double largest = portable::pow(bounds.net_max(), 1.0 / m);
  const double steepest = largest_net_gradient(bounds, bounds.added.sum_min, largest, m);
  double gradient = steepest;
  if (height < std::numeric_limits<double>::infinity()) {
    // Points with |s| <= height have |M - 1| <= height |grad M|.
    for (int pass = 0; pass < 3; ++pass) {
      const double change = height * metaball_divisor(body, gradient);
      const double least = 0.999 * (1.0 - change) - 1e-4, most = 1.001 * (1.0 + change) + 1e-4;
      if (least <= 0.0) break;
      const double sum = portable::pow(least, m) * bounds.subtracted.sum_min;
      gradient = std::min(gradient, largest_net_gradient(bounds, sum, std::min(largest, most), m));
    }
  }
  // The float rounding of the sums, powers and logarithms, and of the coordinates.
  const double kinds = bounds.subtractive() ? 2.0 : 1.0;
  const double slack = 2e-6 + kinds * (1e-5 + 1e-4 / m) * largest + coordinate_rounding(box) * steepest;
  return {portable::pow(bounds.net_min(), 1.0 / m) - 1.0 - slack, largest - 1.0 + slack,
          metaball_divisor(body, gradient)};
}

// The unit direction in which P falls fastest at p.
ASTROLITH_HD inline Vec3d compact_outward(const MetaballParameters<float>& body, const MetaballList& spheres,
                                          const Vec3d& p) {
  const CompactKernel<double> compact_kernel = kernel_in_double(body);
  Vec3d sum;
  for (std::uint32_t i = 0; i < spheres.count; ++i) {
    const MetaballSphere<float>& s = spheres[i];
    if (s.subtractive()) break;
    const double inverse = double{s.inverse_radius_squared};
    const Vec3d d = p - Vec3d{s.center.x, s.center.y, s.center.z};
    const double q = squared_norm(d) * inverse;
    if (!(q < double{body.cutoff_squared})) continue;
    const KernelDerivatives<double> k = kernel_value(compact_kernel, q);
    if (!(k.value > double{kLeastKernel})) continue;
    const double slope = double{body.m} * portable::pow(k.value, double{body.m} - 1.0) * k.slope;
    sum += slope * inverse * d;
  }
  return normalized(sum);
}

// A lower bound of |grad M| where |grad P^(1/m)| is at least `added_gradient`.
ASTROLITH_HD inline double least_net_gradient(const BodyIntervals& bounds, double added_gradient, double m) {
  const double subtracted_gradient =
      portable::pow(bounds.net_max(), 1.0 / m) *
      largest_compact_gradient(bounds.subtracted, bounds.subtracted.sum_min, m);
  // Where A is not large beside the floor kKernelFloor, the floor reduces the slope of M.
  const double floor_weight =
      std::min(1.0, double{kKernelFloor} * bounds.subtracted.sum_max / bounds.added.sum_min);
  const double least = added_gradient * (1.0 - floor_weight) - subtracted_gradient * (1.0 + kDistanceSlack);
  return std::max(0.0, least) / portable::pow(bounds.subtracted.sum_max, 1.0 / m);
}

// A lower bound of the divisor of s over a box, for kernels other than the Gaussian. It bounds the component
// of grad P^(1/m) along one direction.
ASTROLITH_HD inline double smallest_compact_gradient(const MetaballParameters<float>& body,
                                                     const MetaballList& spheres, const Box& box,
                                                     KernelInterval* scratch) {
  const double m = double{body.m}, saturation = portable::exp(double{kLargestExponent});
  const Box rounded = widened(box, coordinate_rounding(box));
  const BodyIntervals bounds = bound_compact_kernels(body, spheres, rounded, scratch);
  const KernelIntervals& added = bounds.added;
  // The sum of the weighted components of grad K_i along one direction, bounded from below.
  const Vec3d center = box.center(), u = compact_outward(body, spheres, center);
  const double spread = spread_along(box, u) + coordinate_rounding(box);
  double component = 0.0;
  for (std::uint32_t i = 0; i < added.count; ++i) {
    const KernelInterval& k = added.kernels[i];
    const Vec3d c{k.sphere->center.x, k.sphere->center.y, k.sphere->center.z};
    const double along = 2.0 * double{k.sphere->inverse_radius_squared} * (dot(center - c, u) - spread);
    if (along <= 0.0) {
      component += along * k.slope_max * compact_weight(k.max, added.sum_min - k.min + k.max, m);
    } else if (k.max < saturation) {
      component += along * k.slope_min * compact_weight(k.min, added.sum_max - k.max + k.min, m);
    }
  }
  component *= 1.0 - 1e-4;
  if (bounds.subtractive()) component = least_net_gradient(bounds, component, m);
  return std::max(std::sqrt(double{body.gradient_floor}), component) * (1.0 - kDistanceSlack);
}

// The bounds for any kernel.
ASTROLITH_HD inline MetaballInterval bound_metaballs(const MetaballParameters<float>& body,
                                                     const MetaballList& spheres, const Box& box,
                                                     double height, KernelInterval* scratch) {
  return body.compact_kernel.kernel == Kernel::kGaussian
             ? bound_gaussian_body(body, spheres, box, height, scratch)
             : bound_compact_body(body, spheres, box, height, scratch);
}
ASTROLITH_HD inline double smallest_gradient(const MetaballParameters<float>& body,
                                             const MetaballList& spheres, const Box& box,
                                             KernelInterval* scratch) {
  return body.compact_kernel.kernel == Kernel::kGaussian
             ? smallest_gaussian_gradient(body, spheres, box, scratch)
             : smallest_compact_gradient(body, spheres, box, scratch);
}

}  // namespace astrolith
