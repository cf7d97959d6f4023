#include "synthesis/metaball_body.h"

#include <algorithm>
#include <cmath>

#include "synthesis/metaball_box.h"

namespace astrolith {
namespace {

// Exponent, relative to the surface's, below which a kernel is cut off.
constexpr double kNegligibleExponent = 20.0;

// Of a kernel other than the Gaussian, all but the gradient's floor.
MetaballParameters<float> profile_parameters(const MetaballBody& body) {
  double cutoff_squared = body.cutoff_radii * body.cutoff_radii;
  const KernelProfile<double> profile = scaled_kernel(body.kernel, body.a, body.a / body.b, cutoff_squared);
  MetaballParameters<float> parameters;
  parameters.m = static_cast<float>(body.blend_exponent);
  parameters.inverse_m = static_cast<float>(1.0 / body.blend_exponent);
  parameters.cutoff_squared = static_cast<float>(cutoff_squared);
  parameters.profile = {profile.kernel, static_cast<float>(profile.scale), static_cast<float>(profile.low),
                        static_cast<float>(profile.height / body.iso_value)};
  return parameters;
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
  const double gradient_floor = 1e-3 / largest_radius;
  if (body.kernel != Kernel::kGaussian) {
    prepared.parameters = profile_parameters(body);
    prepared.parameters.gradient_floor = static_cast<float>(gradient_floor * gradient_floor);
    return prepared;
  }
  const double negligible = (body.a - log_iso + kNegligibleExponent / m) / body.b;
  const double cutoff_squared = std::max(0.0, std::min(body.cutoff_radii * body.cutoff_radii, negligible));
  prepared.parameters = {static_cast<float>(m * (body.a - log_iso)),
                         static_cast<float>(m * body.b),
                         static_cast<float>(1.0 / m),
                         0.0f,
                         static_cast<float>(cutoff_squared),
                         static_cast<float>(gradient_floor * gradient_floor),
                         {},
                         0.0f};
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

namespace {

// Of kernels other than the Gaussian. With f_i = K_i^m, S = sum_i f_i, u_i = (p - c_i)/r_i^2 and M = S^(1/m),
//   grad S = sum_i 2 f_i' u_i,    H_S = sum_i 4 f_i'' u_i u_i' + 2 f_i' / r_i^2 I,
//   grad M = M grad S / (m S),    H_M = M / (m S) (H_S + (1/m - 1) grad S grad S' / S).
Vec3d profile_distance_gradient(const PreparedMetaballs& metaballs, const Vec3d& p) {
  const MetaballParameters<double> body = in_double(metaballs.parameters);
  double sum = kKernelFloor, curvature = 0.0;
  Vec3d gradient, xx, yy;  // xx: the products (x x, x y, x z) of H_S; yy: (y y, y z, z z)
  for (const MetaballSphere<float>& s : metaballs.spheres) {
    const double inverse = s.inverse_radius_squared;
    const Vec3d d = p - Vec3d{s.center.x, s.center.y, s.center.z}, u = d * inverse;
    const ProfileValue<double> f = kernel_power(body, squared_norm(d) * inverse);
    sum += f.value;
    gradient += -2.0 * f.slope * u;
    curvature += -2.0 * f.slope * inverse;
    xx += 4.0 * f.curvature * u.x * u;
    yy += 4.0 * f.curvature * Vec3d{u.y * u.y, u.y * u.z, u.z * u.z};
  }
  const double norm = std::pow(sum, 1.0 / body.m), factor = norm / (body.m * sum);
  const Vec3d g = factor * gradient;
  const Vec3d outer_g{dot(xx, g), xx.y * g.x + yy.x * g.y + yy.y * g.z, xx.z * g.x + yy.y * g.y + yy.z * g.z};
  const Vec3d hessian_g =
      factor * (outer_g + curvature * g + (1.0 / body.m - 1.0) / sum * dot(gradient, g) * gradient);
  const double n = std::sqrt(squared_norm(g) + body.gradient_floor);
  return g * (1.0 / n) - (norm - 1.0) / (n * n * n) * hessian_g;
}

}  // namespace

Vec3d distance_gradient(const PreparedMetaballs& metaballs, const Vec3d& p) {
  const MetaballParameters<float>& body = metaballs.parameters;
  if (body.profile.kernel != Kernel::kGaussian) return profile_distance_gradient(metaballs, p);
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
