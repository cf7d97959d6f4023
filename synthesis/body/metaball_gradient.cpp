// Second derivatives of the field of the metaballs. Let f_i = K_i^m and u_i = (p - c_i) / r_i^2. P and N are
// the sums of f_i over the spheres that add and over the subtractive ones, and A = P / (1 + N) as in
// metaballs.h. H are second derivatives, v' is a transposed vector:
//
//   grad P = sum_i 2 f_i' u_i,    H_P = sum_i 4 f_i'' u_i u_i' + 2 f_i' / r_i^2 I,    N likewise,
//   H_A = (H_P - A H_N - grad A grad N' - grad N grad A') / (1 + N),
//   L = log(A) / m:      grad L = grad A / (m A),      H_L = H_A / (m A) - m grad L grad L',
//   M = A^(1/m):         grad M = M grad A / (m A),    H_M = M / (m A) (H_A + (1/m - 1) grad A grad A' / A).
#include "numerics/portable_double.h"
#include "synthesis/body/metaball_body.h"

namespace astrolith {
namespace {

// A sum of kernels and its derivatives at a point.
struct SumDerivatives {
  double value = 0.0;
  Vec3d gradient;

  void add(const MetaballParameters<double>& body, const MetaballSphere<float>& sphere, const Vec3d& p) {
    const double inverse = sphere.inverse_radius_squared;
    const Vec3d d = p - Vec3d{sphere.center.x, sphere.center.y, sphere.center.z}, u = d * inverse;
    const KernelDerivatives<double> f = kernel_power(body, squared_norm(d) * inverse);
    value += f.value;
    gradient += -2.0 * f.slope * u;
    curvature_ += -2.0 * f.slope * inverse;
    xx_ += 4.0 * f.curvature * u.x * u;
    yy_ += 4.0 * f.curvature * Vec3d{u.y * u.y, u.y * u.z, u.z * u.z};
  }
  // The product H v of the second derivatives with a vector.
  Vec3d hessian_times(const Vec3d& v) const {
    const Vec3d outer{dot(xx_, v), xx_.y * v.x + yy_.x * v.y + yy_.y * v.z,
                      xx_.z * v.x + yy_.y * v.y + yy_.z * v.z};
    return outer + curvature_ * v;
  }

 private:
  double curvature_ = 0.0;  // factor of the identity in H
  Vec3d xx_, yy_;           // the products (x x, x y, x z) and (y y, y z, z z)
};

SumDerivatives sum_over(std::span<const MetaballSphere<float>> spheres,
                        const MetaballParameters<double>& body, const Vec3d& p) {
  SumDerivatives sum;
  for (const MetaballSphere<float>& s : spheres) sum.add(body, s.as_adding(), p);
  return sum;
}

}  // namespace

Vec3d distance_gradient(const MetaballsView& metaballs, const Vec3d& p) {
  const MetaballParameters<double> body = in_double(metaballs.parameters);
  const SumDerivatives added = sum_over(metaballs.adding(), body, p),
                       subtracted = sum_over(metaballs.subtractive(), body, p);
  const double part = 1.0 / (1.0 + subtracted.value), net = added.value * part,
               total = net + double{kKernelFloor};
  const Vec3d net_gradient = part * (added.gradient - net * subtracted.gradient);
  const auto net_hessian_times = [&](const Vec3d& v) {
    return part * (added.hessian_times(v) - net * subtracted.hessian_times(v) -
                   dot(subtracted.gradient, v) * net_gradient - dot(net_gradient, v) * subtracted.gradient);
  };
  // H_L and H_M have the same form with different factors of grad A grad A'.
  const bool gaussian = body.compact_kernel.kernel == Kernel::kGaussian;
  const double norm = gaussian ? 1.0 : portable::pow(total, body.inverse_m);
  const double level = gaussian ? portable::log(total) * body.inverse_m : norm - 1.0;
  const double factor = norm * body.inverse_m / total,
               joined = (gaussian ? -1.0 : body.inverse_m - 1.0) / total;
  const Vec3d g = factor * net_gradient;
  const Vec3d hessian_g = factor * (net_hessian_times(g) + joined * dot(net_gradient, g) * net_gradient);
  // s = level / n with n = sqrt(|g|^2 + floor), so grad s = g/n - level/n^3 H g.
  const double n = std::sqrt(squared_norm(g) + body.gradient_floor);
  return g * (1.0 / n) - level / (n * n * n) * hessian_g;
}

}  // namespace astrolith
