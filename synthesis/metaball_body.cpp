#include "synthesis/metaball_body.h"

#include <algorithm>
#include <cmath>

#include "synthesis/metaball_box_internal.h"

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
