// What is certain about metaballs over a box, for kernels other than the Gaussian. A kernel and its slope
// both fall with the distance from its centre, so that the nearest and the farthest point of a box tell.
//
// With w_i = (K_i / M)^(m-1), grad M = sum_i w_i grad K_i; since sum_i (K_i / M)^m = 1 no w_i is above 1.
#include <algorithm>
#include <cmath>

#include "synthesis/metaball_body.h"
#include "synthesis/metaball_box_internal.h"

namespace astrolith {
namespace {

struct ProfileInterval {
  const MetaballSphere<float>* sphere;
  double power_min, power_max;  // of K^m
  double slope_min, slope_max;  // of -dK/dq
  double gradient_max;          // of |grad K|
};

struct ProfileIntervals {
  std::vector<ProfileInterval> kernels;
  double sum_min = kKernelFloor, sum_max = kKernelFloor;  // of K^m
};

constexpr double kValueRounding = 4e-6;  // of a kernel in float, over its height at the centre

// K with the rounding of a float evaluation, to the power m and saturated.
double power_of(double k, double m) {
  return k > 0.0 ? std::min(std::pow(k, m), std::exp(double{kLargestExponent})) : 0.0;
}

void bound_kernels(const PreparedMetaballs& metaballs, const Box& box, ProfileIntervals& result) {
  const MetaballParameters<double> body = in_double(metaballs.parameters);
  const double rounding = kValueRounding * body.profile.height;
  result.kernels.clear();
  result.sum_min = result.sum_max = kKernelFloor;
  for (const MetaballSphere<float>& s : metaballs.spheres) {
    const double inverse = s.inverse_radius_squared;
    const SquaredDistances d = squared_distances(s, box);
    const double q_min = d.nearest * inverse * (1.0 - kDistanceSlack);
    const double q_max = d.farthest * inverse * (1.0 + kDistanceSlack);
    if (q_min >= body.cutoff_squared) continue;
    const bool inside = q_max < body.cutoff_squared;
    const ProfileValue<double> near = kernel_value(body.profile, q_min);
    const ProfileValue<double> far = kernel_value(body.profile, inside ? q_max : body.cutoff_squared);
    const double power_max = power_of(std::max(near.value, 0.0) + rounding, body.m);
    const double power_min = inside ? power_of(far.value - rounding, body.m) : 0.0;
    const double slope_max = near.slope * (1.0 + kValueRounding) + rounding * body.profile.scale;
    const double gradient_max = 2.0 * slope_max * std::sqrt(std::min(q_max, body.cutoff_squared) * inverse);
    result.kernels.push_back(
        {&s, power_min, power_max, inside ? far.slope * (1.0 - 1e-5) : 0.0, slope_max, gradient_max});
    result.sum_min += power_min;
    result.sum_max += power_max;
  }
}

// Of w_i, from K_i^m and the sum of all.
double weight_of(double power, double sum, double m) {
  return std::pow(std::min(1.0, power / sum), 1.0 - 1.0 / m);
}

// Of |grad M| where the sum of K^m is at least `sum`; the second bound is Hoelder's inequality.
double largest_gradient(const ProfileIntervals& bounds, double sum, double m) {
  double weighted = 0.0, powers = 0.0;
  double steepest = 0.0;
  for (const ProfileInterval& k : bounds.kernels) steepest = std::max(steepest, k.gradient_max);
  if (steepest == 0.0) return 0.0;
  for (const ProfileInterval& k : bounds.kernels) {
    const double least_sum = std::max(sum, bounds.sum_min - k.power_min + k.power_max);
    weighted += weight_of(k.power_max, least_sum, m) * k.gradient_max;
    powers += std::pow(k.gradient_max / steepest, m);
  }
  return std::min(weighted, steepest * std::pow(powers, 1.0 / m)) * (1.0 + 3.0 * kDistanceSlack);
}

double divisor(const MetaballParameters<float>& body, double gradient) {
  return std::sqrt(gradient * gradient + static_cast<double>(body.gradient_floor)) * (1.0 + kDistanceSlack);
}

// The direction in which M falls fastest at a point.
Vec3d outward_direction(const PreparedMetaballs& metaballs, const Vec3d& p) {
  const MetaballParameters<double> body = in_double(metaballs.parameters);
  Vec3d sum;
  for (const MetaballSphere<float>& s : metaballs.spheres) {
    const double inverse = s.inverse_radius_squared;
    const Vec3d d = p - Vec3d{s.center.x, s.center.y, s.center.z};
    sum += kernel_power(body, squared_norm(d) * inverse).slope * inverse * d;
  }
  return normalized(sum);
}

// How far a float coordinate may be from what it stands for.
double coordinate_rounding(const Box& box) { return 1e-6 * (norm(box.center()) + 0.5 * box.diagonal()); }

}  // namespace

MetaballInterval bound_profiles(const PreparedMetaballs& metaballs, const Box& box, double height) {
  const MetaballParameters<float>& body = metaballs.parameters;
  const double m = body.m;
  thread_local ProfileIntervals bounds;
  bound_kernels(metaballs, box, bounds);
  const double steepest = largest_gradient(bounds, bounds.sum_min, m);
  double gradient = steepest;
  if (std::isfinite(height)) {
    // There M is at least 1 - height |grad M|.
    for (int pass = 0; pass < 3; ++pass) {
      const double least = 0.999 * (1.0 - height * divisor(body, gradient)) - 1e-4;
      if (least <= 0.0) break;
      gradient = std::min(gradient, largest_gradient(bounds, std::pow(least, m), m));
    }
  }
  const double largest = std::pow(bounds.sum_max, 1.0 / m);
  // Float rounding: of the sums, the powers and the logarithms, and of the coordinates.
  const double slack = 2e-6 + (1e-5 + 1e-4 / m) * largest + coordinate_rounding(box) * steepest;
  return {std::pow(bounds.sum_min, 1.0 / m) - 1.0 - slack, largest - 1.0 + slack, divisor(body, gradient)};
}

double smallest_profile_gradient(const PreparedMetaballs& metaballs, const Box& box) {
  const MetaballParameters<float>& body = metaballs.parameters;
  const double m = body.m, saturation = std::exp(double{kLargestExponent});
  thread_local ProfileIntervals bounds;
  bound_kernels(metaballs, box, bounds);
  // The component along one direction, of each grad K_i and so of their weighted sum.
  const Vec3d center = box.center(), half = 0.5 * box.extent(), u = outward_direction(metaballs, center);
  const double spread =
      std::fabs(u.x) * half.x + std::fabs(u.y) * half.y + std::fabs(u.z) * half.z + coordinate_rounding(box);
  double component = 0.0;
  for (const ProfileInterval& k : bounds.kernels) {
    const double inverse = k.sphere->inverse_radius_squared;
    const Vec3d c{k.sphere->center.x, k.sphere->center.y, k.sphere->center.z};
    const double along = 2.0 * inverse * (dot(center - c, u) - spread);
    const double least_sum = bounds.sum_min - k.power_min + k.power_max;
    if (along <= 0.0) {
      component += along * k.slope_max * weight_of(k.power_max, least_sum, m);
    } else if (k.power_max < saturation) {
      component +=
          along * k.slope_min * weight_of(k.power_min, bounds.sum_max - k.power_max + k.power_min, m);
    }
  }
  return std::max(std::sqrt(static_cast<double>(body.gradient_floor)), component * (1.0 - 1e-4)) *
         (1.0 - kDistanceSlack);
}

}  // namespace astrolith
