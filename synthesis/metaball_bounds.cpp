// What is certain about metaballs over a box. Kernels other than the Gaussian: profile_bounds.cpp.
#include <algorithm>
#include <cmath>

#include "synthesis/metaball_body.h"
#include "synthesis/metaball_box_internal.h"

namespace astrolith {
namespace {

// A kernel over a box: least and greatest value, and the greatest |grad log f_i| / m.
struct KernelInterval {
  const MetaballSphere<float>* sphere;
  double min, max, slope_max;
};

// Of the spheres that reach a box, and of the sum of their kernels there.
struct KernelIntervals {
  std::vector<KernelInterval> kernels;
  double sum_min = kKernelFloor, sum_max = kKernelFloor;
};

// `result` is cleared first; to be reused, since it is filled for thousands of boxes.
void bound_kernels(const PreparedMetaballs& metaballs, const Box& box, KernelIntervals& result) {
  const MetaballParameters<float>& body = metaballs.parameters;
  const double m_a = body.m_a, m_b = body.m_b, m = 1.0 / static_cast<double>(body.inverse_m);
  const double cutoff = body.cutoff_squared;
  const auto kernel = [&](double q) { return std::exp(std::min(m_a - m_b * q, double{kLargestExponent})); };
  result.kernels.clear();
  result.sum_min = result.sum_max = kKernelFloor;
  for (const MetaballSphere<float>& s : metaballs.spheres) {
    const double inverse = s.inverse_radius_squared;
    const SquaredDistances d = squared_distances(s, box);
    const double q_min = d.nearest * inverse * (1.0 - kDistanceSlack);
    const double q_max = d.farthest * inverse * (1.0 + kDistanceSlack);
    if (q_min >= cutoff) continue;
    const double f_max = kernel(q_min);
    const double f_min = q_max < cutoff ? kernel(q_max) : 0.0;
    const double q_far = std::min(q_max, cutoff);
    result.kernels.push_back({&s, f_min, f_max, 2.0 * m_b / m * std::sqrt(q_far * inverse)});
    result.sum_min += f_min;
    result.sum_max += f_max;
  }
}

// Of |grad L| = |sum_i w_i grad log f_i| / m, with w_i <= f_i,max / (f_i,max + the others' minima) and
// weights that add up to at most one. The bounds of meshes, and so their grids, depend on it.
double largest_gradient(const KernelIntervals& bounds) {
  double weighted = 0.0, steepest = 0.0;
  for (const KernelInterval& k : bounds.kernels) {
    weighted += k.slope_max * k.max / (bounds.sum_min - k.min + k.max);
    steepest = std::max(steepest, k.slope_max);
  }
  return std::min(weighted, steepest) * (1.0 + kDistanceSlack);
}

// The same where the kernels' sum is at least `sum`: the steepest kernels get all the weight they may.
// Expects those first.
double largest_gradient(const KernelIntervals& bounds, double sum) {
  double gradient = 0.0, left = 1.0;
  for (const KernelInterval& k : bounds.kernels) {
    const double weight = std::min(left, k.max / std::max(sum, bounds.sum_min - k.min + k.max));
    gradient += k.slope_max * weight;
    left -= weight;
    if (left <= 0.0) break;
  }
  return gradient * (1.0 + kDistanceSlack);
}

// The divisor of s for a |grad L|, rounded up.
double divisor(const MetaballParameters<float>& body, double gradient) {
  return std::sqrt(gradient * gradient + static_cast<double>(body.gradient_floor)) * (1.0 + kDistanceSlack);
}

constexpr int kGradientPasses = 3;

// The largest 1 / r_i^2: how fast a gradient may change with the rounding of coordinates.
double steepest_curvature(const KernelIntervals& bounds) {
  double largest = 0.0;
  for (const KernelInterval& k : bounds.kernels) {
    largest = std::max(largest, static_cast<double>(k.sphere->inverse_radius_squared));
  }
  return largest;
}

// The direction in which the sum of kernels falls fastest at a point.
Vec3d outward_direction(const PreparedMetaballs& metaballs, const Vec3d& p) {
  const MetaballParameters<float>& body = metaballs.parameters;
  Vec3d sum;
  for (const MetaballSphere<float>& s : metaballs.spheres) {
    const double inverse = s.inverse_radius_squared;
    const Vec3d d = p - Vec3d{s.center.x, s.center.y, s.center.z};
    const double q = squared_norm(d) * inverse;
    if (q >= static_cast<double>(body.cutoff_squared)) continue;
    const double exponent = static_cast<double>(body.m_a) - static_cast<double>(body.m_b) * q;
    sum += std::exp(std::min(exponent, double{kLargestExponent})) * inverse * d;
  }
  return normalized(sum);
}

}  // namespace

MetaballInterval bound_metaballs(const PreparedMetaballs& metaballs, const Box& box, double height) {
  const MetaballParameters<float>& body = metaballs.parameters;
  if (body.profile.kernel != Kernel::kGaussian) return bound_profiles(metaballs, box, height);
  const double m_a = body.m_a, m = 1.0 / static_cast<double>(body.inverse_m);
  thread_local KernelIntervals bounds;
  bound_kernels(metaballs, box, bounds);
  const double sum_min = bounds.sum_min, sum_max = bounds.sum_max;
  const double steepest = largest_gradient(bounds);
  double gradient = steepest;
  if (std::isfinite(height)) {
    std::sort(bounds.kernels.begin(), bounds.kernels.end(),
              [](const KernelInterval& i, const KernelInterval& j) { return i.slope_max > j.slope_max; });
    // There the kernels' sum is at least e^(-m height |grad L|).
    for (int pass = 0; pass < kGradientPasses; ++pass) {
      const double sum = 0.999 * std::exp(-m * height * divisor(body, gradient));
      gradient = std::min(gradient, largest_gradient(bounds, sum));
    }
  }
  const double coordinate = std::max({std::fabs(box.min.x), std::fabs(box.min.y), std::fabs(box.min.z),
                                      std::fabs(box.max.x), std::fabs(box.max.y), std::fabs(box.max.z)});
  // Float rounding: of the exponents and the logarithm, and of the coordinates.
  const double slack = (3e-5 + 1e-6 * std::fabs(m_a)) / m + 1e-6 * coordinate * steepest;
  return {std::log(sum_min) / m - slack, std::log(sum_max) / m + slack, divisor(body, gradient)};
}

double smallest_gradient(const PreparedMetaballs& metaballs, const Box& box) {
  const MetaballParameters<float>& body = metaballs.parameters;
  if (body.profile.kernel != Kernel::kGaussian) return smallest_profile_gradient(metaballs, box);
  const double b = static_cast<double>(body.m_b) * static_cast<double>(body.inverse_m);
  thread_local KernelIntervals bounds;
  bound_kernels(metaballs, box, bounds);
  // The component along one direction, of each grad log f_i / m and of their weighted mean.
  const Vec3d center = box.center(), half = 0.5 * box.extent(), u = outward_direction(metaballs, center);
  const double spread = std::fabs(u.x) * half.x + std::fabs(u.y) * half.y + std::fabs(u.z) * half.z;
  double weighted = 0.0, least = HUGE_VAL;
  for (const KernelInterval& k : bounds.kernels) {
    const Vec3d c{k.sphere->center.x, k.sphere->center.y, k.sphere->center.z};
    const double component =
        2.0 * b * static_cast<double>(k.sphere->inverse_radius_squared) * (dot(center - c, u) - spread);
    weighted += component * (component > 0.0 ? k.min / (bounds.sum_max - k.max + k.min)
                                             : k.max / (bounds.sum_min - k.min + k.max));
    least = std::min(least, component);
  }
  if (bounds.kernels.empty()) least = 0.0;
  const double floor_weight = double{kKernelFloor} / bounds.sum_min;  // of what has no gradient
  const double coordinate = norm(center) + norm(half);
  const double rounding = 1e-6 * coordinate * 2.0 * b * steepest_curvature(bounds);
  const double gradient = std::max({0.0, weighted, least * (1.0 - floor_weight)}) * (1.0 - kDistanceSlack);
  return std::max(std::sqrt(static_cast<double>(body.gradient_floor)) * (1.0 - kDistanceSlack),
                  gradient - rounding);
}

}  // namespace astrolith
