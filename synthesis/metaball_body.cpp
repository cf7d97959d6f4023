#include "synthesis/metaball_body.h"

#include <algorithm>
#include <cmath>

namespace astrolith {
namespace {

// Exponent, relative to the surface's, below which a kernel is cut off.
constexpr double kNegligibleExponent = 20.0;

ASTROLITH_SIMD_CLONES void accumulate_spheres(const MetaballParameters<float>& body,
                                              const MetaballSphere<float>* spheres, std::size_t num_spheres,
                                              int n, const float* __restrict x, const float* __restrict y,
                                              const float* __restrict z, float* __restrict kernel,
                                              float* __restrict wx, float* __restrict wy,
                                              float* __restrict wz) {
  const MetaballParameters<float> parameters = body;
  for (std::size_t j = 0; j < num_spheres; ++j) {
    const MetaballSphere<float> sphere = spheres[j];
#pragma omp simd
    for (int i = 0; i < n; ++i) {
      MetaballSums<float> sums{kernel[i], {wx[i], wy[i], wz[i]}};
      accumulate_metaball(parameters, sphere, Vec3f{x[i], y[i], z[i]}, sums);
      kernel[i] = sums.kernel;
      wx[i] = sums.weighted.x;
      wy[i] = sums.weighted.y;
      wz[i] = sums.weighted.z;
    }
  }
}

// Turns the sums into s and grad L in place.
ASTROLITH_SIMD_CLONES void finish_distances(const MetaballParameters<float>& body, int n,
                                            float* __restrict kernel, float* __restrict wx,
                                            float* __restrict wy, float* __restrict wz) {
  const MetaballParameters<float> parameters = body;
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    const SurfaceDistance<float> d =
        metaball_distance(parameters, MetaballSums<float>{kernel[i], {wx[i], wy[i], wz[i]}});
    kernel[i] = d.distance;
    wx[i] = d.log_gradient.x;
    wy[i] = d.log_gradient.y;
    wz[i] = d.log_gradient.z;
  }
}

double nearest_offset(double c, double lo, double hi) { return c < lo ? lo - c : c > hi ? c - hi : 0.0; }
double farthest_offset(double c, double lo, double hi) {
  return std::max(std::fabs(c - lo), std::fabs(c - hi));
}

struct SquaredDistances {
  double nearest;
  double farthest;
};

// From a sphere's centre to the box.
SquaredDistances squared_distances(const MetaballSphere<float>& sphere, const Box& box) {
  const Vec3d c{sphere.center.x, sphere.center.y, sphere.center.z};
  const Vec3d near{nearest_offset(c.x, box.min.x, box.max.x), nearest_offset(c.y, box.min.y, box.max.y),
                   nearest_offset(c.z, box.min.z, box.max.z)};
  const Vec3d far{farthest_offset(c.x, box.min.x, box.max.x), farthest_offset(c.y, box.min.y, box.max.y),
                  farthest_offset(c.z, box.min.z, box.max.z)};
  return {squared_norm(near), squared_norm(far)};
}

// Relative slack on squared distances: float points and float arithmetic differ from ours by less.
constexpr double kDistanceSlack = 1e-5;

}  // namespace

PreparedMetaballs prepare_metaballs(const MetaballBody& body) {
  const double m = body.blend_exponent;
  const double log_iso = std::log(body.iso_value);
  double largest_radius = 0.0;
  PreparedMetaballs prepared;
  for (const Sphere& s : body.spheres) {
    largest_radius = std::max(largest_radius, s.radius);
    const Vec3f center{static_cast<float>(s.center.x), static_cast<float>(s.center.y),
                       static_cast<float>(s.center.z)};
    prepared.spheres.push_back({center, static_cast<float>(1.0 / (s.radius * s.radius))});
  }
  const double negligible = (body.a - log_iso + kNegligibleExponent / m) / body.b;
  const double cutoff_squared = std::max(0.0, std::min(body.cutoff_radii * body.cutoff_radii, negligible));
  const double gradient_floor = 1e-3 / largest_radius;
  prepared.parameters = {static_cast<float>(m * (body.a - log_iso)),
                         static_cast<float>(m * body.b),
                         static_cast<float>(1.0 / m),
                         0.0f,
                         static_cast<float>(cutoff_squared),
                         static_cast<float>(gradient_floor * gradient_floor)};
  return prepared;
}

PreparedMetaballs metaballs_reaching(const PreparedMetaballs& metaballs, const Box& box) {
  PreparedMetaballs reaching{metaballs.parameters, {}};
  const double limit = static_cast<double>(metaballs.parameters.cutoff_squared) * (1.0 + kDistanceSlack);
  for (const MetaballSphere<float>& s : metaballs.spheres) {
    const double q = squared_distances(s, box).nearest * static_cast<double>(s.inverse_radius_squared);
    if (!(q > limit)) reaching.spheres.push_back(s);
  }
  return reaching;
}

Box support_bounds(const PreparedMetaballs& metaballs) {
  Box box;
  for (const MetaballSphere<float>& s : metaballs.spheres) {
    const double reach =
        std::sqrt((1.0 + kDistanceSlack) * static_cast<double>(metaballs.parameters.cutoff_squared) /
                  static_cast<double>(s.inverse_radius_squared));
    const Vec3d c{s.center.x, s.center.y, s.center.z};
    box.extend(c - Vec3d{reach, reach, reach});
    box.extend(c + Vec3d{reach, reach, reach});
  }
  return box;
}

void evaluate_metaballs(const PreparedMetaballs& metaballs, int n, const float* x, const float* y,
                        const float* z, float* distance, float* gradient_x, float* gradient_y,
                        float* gradient_z) {
  constexpr int kBatch = 256;  // seven arrays of so many floats stay in the first cache over all spheres
  for (float* sum : {distance, gradient_x, gradient_y, gradient_z}) std::fill(sum, sum + n, 0.0f);
  for (int begin = 0; begin < n; begin += kBatch) {
    const int size = std::min(kBatch, n - begin);
    float *s = distance + begin, *gx = gradient_x + begin, *gy = gradient_y + begin, *gz = gradient_z + begin;
    accumulate_spheres(metaballs.parameters, metaballs.spheres.data(), metaballs.spheres.size(), size,
                       x + begin, y + begin, z + begin, s, gx, gy, gz);
    finish_distances(metaballs.parameters, size, s, gx, gy, gz);
  }
}

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

Vec3d distance_gradient(const PreparedMetaballs& metaballs, const Vec3d& p) {
  const MetaballParameters<float>& body = metaballs.parameters;
  const double m_b = body.m_b, inverse_m = body.inverse_m, cutoff = body.cutoff_squared;
  // Sums over spheres of f, f v, f/r^2 and f v v', with v = (p - c)/r^2.
  double total = kKernelFloor, curvature = 0.0;
  Vec3d first, xx, yy;  // xx: the products (x x, x y, x z); yy: (y y, y z, z z)
  for (const MetaballSphere<float>& s : metaballs.spheres) {
    const double inverse = s.inverse_radius_squared;
    const Vec3d d = p - Vec3d{s.center.x, s.center.y, s.center.z};
    const double q = squared_norm(d) * inverse;
    if (q >= cutoff) continue;
    const double f = std::exp(std::min(static_cast<double>(body.m_a) - m_b * q, double{kLargestExponent}));
    const Vec3d v = d * inverse;
    total += f;
    curvature += f * inverse;
    first += f * v;
    xx += f * v.x * v;
    yy += f * Vec3d{v.y * v.y, v.y * v.z, v.z * v.z};
  }
  // grad L = -2b E[v];  H = -2b E[1/r^2] I + 4 b^2 m (E[v v'] - E[v] E[v]'), E weighted by f / total.
  const double b = m_b * inverse_m;
  const Vec3d mean = first * (1.0 / total);
  const Vec3d g = -2.0 * b * mean;
  const Vec3d second_g =
      Vec3d{dot(xx, g), xx.y * g.x + yy.x * g.y + yy.y * g.z, xx.z * g.x + yy.y * g.y + yy.z * g.z} *
      (1.0 / total);
  const Vec3d hessian_g = -2.0 * b * curvature / total * g + 4.0 * b * m_b * (second_g - dot(mean, g) * mean);
  // s = L / n with n = sqrt(|g|^2 + floor), so grad s = g/n - L/n^3 H g.
  const double n = std::sqrt(squared_norm(g) + static_cast<double>(body.gradient_floor));
  const double level = std::log(total) * inverse_m;
  return g * (1.0 / n) - level / (n * n * n) * hessian_g;
}

}  // namespace astrolith
