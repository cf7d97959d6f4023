// Bounds of metaballs over a box. The code is plain, so that CPU and GPU give the same bits. Here are the
// Gaussian kernels f_i = exp(m (a - b q)); compact_kernel_bounds.h has the others.
#pragma once

#include <algorithm>
#include <cstdint>

#include "numerics/interval.h"
#include "numerics/portable_double.h"
#include "synthesis/body/metaball_body.h"
#include "synthesis/body/metaball_box.h"

namespace astrolith {

// Some metaballs of an array, given by their numbers, or all of them if `numbers` is null. Subtractive
// metaballs come last.
struct MetaballList {
  const MetaballSphere<float>* spheres;
  const std::uint32_t* numbers;
  std::uint32_t count;

  ASTROLITH_HD const MetaballSphere<float>& operator[](std::uint32_t i) const {
    return spheres[numbers == nullptr ? i : numbers[i]];
  }
};

// The range of a kernel over a box: of f_i for Gaussian kernels, of K_i^m for all others.
struct KernelInterval {
  const MetaballSphere<float>* sphere;
  double min, max;
  double gradient_max;          // bound of |grad log f_i| / m, or of |grad K| for other kernels
  double slope_min, slope_max;  // bounds of -dK/dq; unused for Gaussian kernels
};

// The kernels of one kind of spheres that reach a box, and bounds of their sum. The sum includes a constant:
// kKernelFloor for spheres that add, 1 for subtractive spheres.
struct KernelIntervals {
  KernelInterval* kernels;
  std::uint32_t count;
  double sum_min, sum_max;

  ASTROLITH_HD void add(const KernelInterval& kernel) {
    kernels[count++] = kernel;
    sum_min += kernel.min;
    sum_max += kernel.max;
  }
};

// Bounds of a body, with A = P / (1 + N) as in metaballs.h: of P + floor (`added`) and of 1 + N
// (`subtracted`).
struct BodyIntervals {
  KernelIntervals added, subtracted;

  // Bounds of A + floor.
  ASTROLITH_HD double net_min() const { return added.sum_min / subtracted.sum_max; }
  ASTROLITH_HD double net_max() const {
    if (!subtractive()) return added.sum_max;
    return (added.sum_max - double{kKernelFloor}) / subtracted.sum_min + double{kKernelFloor};
  }
  ASTROLITH_HD bool subtractive() const { return subtracted.count != 0; }
};

// Bounds the kernels of all spheres. bound_kernel(sphere, kernel) sets `kernel` and returns whether the
// sphere reaches the box. Expects subtractive spheres last, and room for all spheres in `kernels`.
template <typename BoundKernel>
ASTROLITH_HD BodyIntervals bound_kernels(const MetaballList& spheres, KernelInterval* kernels,
                                         const BoundKernel& bound_kernel) {
  BodyIntervals bounds{{kernels, 0, double{kKernelFloor}, double{kKernelFloor}}, {nullptr, 0, 1.0, 1.0}};
  std::uint32_t i = 0;
  KernelInterval kernel;
  for (; i < spheres.count && !spheres[i].subtractive(); ++i) {
    if (bound_kernel(spheres[i], kernel)) bounds.added.add(kernel);
  }
  bounds.subtracted.kernels = kernels + bounds.added.count;
  for (; i < spheres.count; ++i) {
    if (bound_kernel(spheres[i], kernel)) bounds.subtracted.add(kernel);
  }
  return bounds;
}

// The divisor of s for a given |grad L|, rounded up.
ASTROLITH_HD inline double metaball_divisor(const MetaballParameters<float>& body, double gradient) {
  return std::sqrt(gradient * gradient + static_cast<double>(body.gradient_floor)) * (1.0 + kDistanceSlack);
}

// The least and the largest |p - c|^2 / r^2 over the points p of a box.
ASTROLITH_HD inline Interval squared_radii(const MetaballSphere<float>& s, const Box& box) {
  const double inverse = inverse_square(s);
  const SquaredDistances d = squared_distances(s, box);
  return {d.nearest * inverse * (1.0 - kDistanceSlack), d.farthest * inverse * (1.0 + kDistanceSlack)};
}

// The kernel f = exp(m (a - b q)) at the squared distance q, saturated like the float evaluation.
ASTROLITH_HD inline double gaussian_at(const MetaballParameters<float>& body, double q) {
  return portable::exp(
      std::min(static_cast<double>(body.m_a) - static_cast<double>(body.m_b) * q, double{kLargestExponent}));
}

// Bounds the Gaussian kernels of all spheres that reach the box. `kernels` needs room for all spheres.
ASTROLITH_HD inline BodyIntervals bound_gaussians(const MetaballParameters<float>& body,
                                                  const MetaballList& spheres, const Box& box,
                                                  KernelInterval* kernels) {
  const double m_b = static_cast<double>(body.m_b), m = 1.0 / static_cast<double>(body.inverse_m);
  const double cutoff = static_cast<double>(body.cutoff_squared);
  return bound_kernels(spheres, kernels, [&](const MetaballSphere<float>& s, KernelInterval& kernel) {
    const Interval q = squared_radii(s, box);
    if (q.low >= cutoff) return false;
    const double f_max = gaussian_at(body, q.low);
    const double f_min = q.high < cutoff ? gaussian_at(body, q.high) : 0.0;
    const double slope = std::sqrt(std::min(q.high, cutoff) * inverse_square(s));
    kernel = {&s, f_min, f_max, 2.0 * m_b / m * slope, 0.0, 0.0};
    return true;
  });
}

// An upper bound of |sum_i w_i grad log f_i| / m over the spheres of one kind. The weights f_i / P or f_i /
// (1 + N) add up to at most 1, and w_i <= f_i,max / (f_i,max + the minima of the others). |grad L| is at most
// the sum of the bounds of both kinds. The bounds of meshes, and so their grids, depend on the bits of this
// function.
ASTROLITH_HD inline double largest_gaussian_gradient(const KernelIntervals& bounds) {
  double weighted = 0.0, steepest = 0.0;
  for (std::uint32_t i = 0; i < bounds.count; ++i) {
    const KernelInterval& k = bounds.kernels[i];
    weighted += k.gradient_max * k.max / (bounds.sum_min - k.min + k.max);
    steepest = std::max(steepest, k.gradient_max);
  }
  return std::min(weighted, steepest) * (1.0 + kDistanceSlack);
}

// An upper bound of the same sum where the kernels' sum is at least `sum`. The steepest kernels get the
// largest weights that they may have. Expects the kernels sorted steepest first.
ASTROLITH_HD inline double largest_gaussian_gradient(const KernelIntervals& bounds, double sum) {
  double gradient = 0.0, left = 1.0;
  for (std::uint32_t i = 0; i < bounds.count && left > 0.0; ++i) {
    const KernelInterval& k = bounds.kernels[i];
    const double weight = std::min(left, k.max / std::max(sum, bounds.sum_min - k.min + k.max));
    gradient += k.gradient_max * weight;
    left -= weight;
  }
  return gradient * (1.0 + kDistanceSlack);
}

// The order by falling slopes. Equal slopes keep the order of their spheres.
ASTROLITH_HD inline bool is_steeper(const KernelInterval& a, const KernelInterval& b) {
  return a.gradient_max != b.gradient_max ? a.gradient_max > b.gradient_max : a.sphere < b.sphere;
}
// A heap sort: it needs no recursion and no memory. The children of i are 2i + 1 and 2i + 2.
ASTROLITH_HD inline void sort_steepest_first(KernelInterval* kernels, std::uint32_t count) {
  const auto sink = [&](std::uint32_t i, std::uint32_t end) {
    for (std::uint32_t child = 2 * i + 1; child < end; i = child, child = 2 * i + 1) {
      if (child + 1 < end && is_steeper(kernels[child], kernels[child + 1])) ++child;
      if (!is_steeper(kernels[i], kernels[child])) return;
      const KernelInterval moved = kernels[i];
      kernels[i] = kernels[child];
      kernels[child] = moved;
    }
  };
  for (std::uint32_t i = count / 2; i > 0; --i) sink(i - 1, count);
  for (std::uint32_t end = count; end > 1; --end) {
    const KernelInterval least = kernels[0];
    kernels[0] = kernels[end - 1];
    kernels[end - 1] = least;
    sink(0, end - 1);
  }
}

// Bounds L - log T over the box, and the divisor of s for points with |s| <= height, which may be infinite;
// for Gaussian kernels. `scratch` needs room for all spheres.
ASTROLITH_HD inline MetaballInterval bound_gaussian_body(const MetaballParameters<float>& body,
                                                         const MetaballList& spheres, const Box& box,
                                                         double height, KernelInterval* scratch) {
  const double m = 1.0 / static_cast<double>(body.inverse_m);
  const BodyIntervals bounds = bound_gaussians(body, spheres, box, scratch);
  const double subtracted_gradient = largest_gaussian_gradient(bounds.subtracted);
  const double steepest = largest_gaussian_gradient(bounds.added) + subtracted_gradient;
  double gradient = steepest;
  if (height < std::numeric_limits<double>::infinity()) {
    sort_steepest_first(bounds.added.kernels, bounds.added.count);
    // Points with |s| <= height have A >= e^(-m height |grad L|). P is A (1 + N).
    for (int pass = 0; pass < 3; ++pass) {
      const double net = 0.999 * portable::exp(-m * height * metaball_divisor(body, gradient));
      const double sum = net * bounds.subtracted.sum_min;
      gradient = std::min(gradient, largest_gaussian_gradient(bounds.added, sum) + subtracted_gradient);
    }
  }
  // The float rounding of the exponents, of the logarithm and of the coordinates.
  const double kinds = bounds.subtractive() ? 2.0 : 1.0;
  const double slack = kinds * (3e-5 + 1e-6 * std::fabs(static_cast<double>(body.m_a))) / m +
                       1e-6 * largest_coordinate(box) * steepest;
  return {portable::log(bounds.net_min()) / m - slack, portable::log(bounds.net_max()) / m + slack,
          metaball_divisor(body, gradient)};
}

// The unit direction in which the sum of the kernels that add falls fastest at p.
ASTROLITH_HD inline Vec3d gaussians_outward(const MetaballParameters<float>& body,
                                            const MetaballList& spheres, const Vec3d& p) {
  Vec3d sum;
  for (std::uint32_t i = 0; i < spheres.count; ++i) {
    const MetaballSphere<float>& s = spheres[i];
    if (s.subtractive()) break;
    const double inverse = static_cast<double>(s.inverse_radius_squared);
    const Vec3d d = p - Vec3d{s.center.x, s.center.y, s.center.z};
    const double q = squared_norm(d) * inverse;
    if (q < static_cast<double>(body.cutoff_squared)) sum += gaussian_at(body, q) * inverse * d;
  }
  return normalized(sum);
}

// A bound of the error of a float coordinate of the points of a box, length units.
ASTROLITH_HD inline double coordinate_rounding(const Box& box) {
  return 1e-6 * (norm(box.center()) + 0.5 * norm(box.extent()));
}

// The largest (p - centre).u over the points p of a box.
ASTROLITH_HD inline double spread_along(const Box& box, const Vec3d& u) {
  const Vec3d half = 0.5 * box.extent();
  return std::fabs(u.x) * half.x + std::fabs(u.y) * half.y + std::fabs(u.z) * half.z;
}

// A box along a unit vector `direction`: every point p of it has |(p - center).direction| <= spread.
struct BoxAlong {
  Vec3d center, direction;
  double spread;
};

// The least value over a box of the component -grad log f_i.direction / m = 2 b / r_i^2 (p - c_i).direction.
ASTROLITH_HD inline double least_component(double b, const MetaballSphere<float>& s, const BoxAlong& box) {
  const double inverse = static_cast<double>(s.inverse_radius_squared);
  const Vec3d c{s.center.x, s.center.y, s.center.z};
  return 2.0 * b * inverse * (dot(box.center - c, box.direction) - box.spread);
}

// A lower bound of |sum_i w_i grad log f_i| / m over the spheres that add, with the weights w_i = f_i / (P +
// floor (1 + N)). It is the larger of two bounds of the sum's component along one direction:
//   - the sum of the least components d_i, each with the least weight if d_i > 0, else with the largest;
//   - the least d_i times the least sum of the weights, which is 1 minus the floor's own weight.
ASTROLITH_HD inline double smallest_added_gradient(const BodyIntervals& bounds, double b,
                                                   const BoxAlong& box) {
  const KernelIntervals& added = bounds.added;
  const double floor_max = double{kKernelFloor} * bounds.subtracted.sum_max;
  const double sum_max =
      bounds.subtractive() ? added.sum_max - double{kKernelFloor} + floor_max : added.sum_max;
  double weighted = 0.0, least = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = 0; i < added.count; ++i) {
    const KernelInterval& k = added.kernels[i];
    const double component = least_component(b, *k.sphere, box);
    const double weight =
        component > 0.0 ? k.min / (sum_max - k.max + k.min) : k.max / (added.sum_min - k.min + k.max);
    weighted += component * weight;
    least = std::min(least, component);
  }
  if (added.count == 0) least = 0.0;
  const double floor_weight = std::min(1.0, floor_max / added.sum_min);
  return std::max(std::max(0.0, weighted), least * (1.0 - floor_weight)) * (1.0 - kDistanceSlack);
}

// The largest 1 / r^2 of the spheres of one kind.
ASTROLITH_HD inline double largest_inverse_square(const KernelIntervals& bounds) {
  double largest = 0.0;
  for (std::uint32_t i = 0; i < bounds.count; ++i) {
    largest = std::max(largest, inverse_square(*bounds.kernels[i].sphere));
  }
  return largest;
}

// A lower bound of the divisor of s over a box, for Gaussian kernels:
//   |grad L| >= |sum_i w_i grad log f_i| / m over the spheres that add - |grad log(1 + N)| / m.
ASTROLITH_HD inline double smallest_gaussian_gradient(const MetaballParameters<float>& body,
                                                      const MetaballList& spheres, const Box& box,
                                                      KernelInterval* scratch) {
  const double b = static_cast<double>(body.m_b) * static_cast<double>(body.inverse_m);
  const BodyIntervals bounds = bound_gaussians(body, spheres, box, scratch);
  const Vec3d center = box.center(), outward = gaussians_outward(body, spheres, center);
  const double added_gradient =
      smallest_added_gradient(bounds, b, {center, outward, spread_along(box, outward)});
  // grad log f_i / m changes by 2 b / r_i^2 times the rounding of a coordinate.
  const double sharpest =
      std::max(largest_inverse_square(bounds.added), largest_inverse_square(bounds.subtracted));
  const double rounding = coordinate_rounding(box) * 2.0 * b * sharpest;
  return std::max(std::sqrt(static_cast<double>(body.gradient_floor)) * (1.0 - kDistanceSlack),
                  added_gradient - rounding - largest_gaussian_gradient(bounds.subtracted));
}

}  // namespace astrolith
