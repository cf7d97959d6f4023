// Metaballs as a smooth signed distance. The code is plain and scalar; the float evaluation in blocks, the
// GPU and the fit in double precision share it.
//
// With k_i(p) = m (a - b |p - c_i|^2 / r_i^2) the p-norm blend of thesis eq. 4.5 is a log-sum-exp,
//
//   log m(p) = L(p) = (1/m) log(sum_i exp k_i(p)),
//
// and the body is the set L >= log T. Near the surface the first-order distance to it is
//
//   s(p) = (L(p) - log T) / |grad L(p)|,     grad L = -2 b sum_i w_i (p - c_i) / r_i^2,  w = softmax(k),
//
// positive inside, in length units. Layers add heights to s. This is eq. 5.1 with every n_i multiplied by
// |grad m|. Amplitudes are then lengths, and they do not depend on the size of the nearby spheres.
//
// The other kernels (compact_kernel.h) have finite supports. At their ends log m has no useful slope. For
// these kernels s is based on the p-norm itself:
//
//   M(p) = (sum_i K_i^m)^(1/m) / T,    s(p) = (M(p) - 1) / |grad M(p)|,
//   grad M = -2 M / (sum_i K_i^m) sum_i K_i^m (-K_i'/K_i) (p - c_i) / r_i^2,     K_i' = dK_i/dq.
//
// Metaballs may be subtractive. Let P be the sum over the spheres that add, and N the sum over the
// subtractive ones. Then
//
//   A = P / (1 + N),    grad A = (grad P - A grad N) / (1 + N)
//
// replaces the sum in all equations above. A = 1 is the surface P - N = 1 of the difference. Unlike P - N, A
// is never negative, so that its logarithm and its roots exist, and it is as smooth as P. Without subtractive
// spheres A = P, bit for bit. Validation keeps P and N below the values where exponents saturate: A would be
// 1 where both saturate.
#pragma once

#include <algorithm>

#include "numerics/host_device.h"
#include "numerics/portable_double.h"
#include "numerics/scalar_math.h"
#include "numerics/vec3.h"
#include "synthesis/body/compact_kernel.h"

namespace astrolith {

// A constant added to the sum of kernels, so that its logarithm is finite where no kernel reaches. There s is
// a large negative number. The constant e^-30 changes no sum that includes a kernel within its support.
inline constexpr float kKernelFloor = 9.3576e-14f;

// The largest exponent of a kernel. Deep inside sharp bodies the field saturates, so that float sums stay
// finite.
inline constexpr float kLargestExponent = 60.0f;

// The least kernel value of which a logarithm is computed.
inline constexpr float kLeastKernel = 1e-30f;

// The parameters of a body, ready for evaluation in the scalar type T.
template <typename T>
struct MetaballParameters {
  T m_a{};                            // m a; Gaussian kernels only
  T m_b{};                            // m b; Gaussian kernels only
  T inverse_m{};                      // 1 / m
  T log_iso{};                        // log T; Gaussian kernels only
  T cutoff_squared{};                 // squared support in radii
  T gradient_floor{};                 // (1e-3 / largest radius)^2, added to |grad|^2 to keep s finite
  CompactKernel<T> compact_kernel{};  // other kernels only; its height includes 1/T
  T m{};                              // other kernels only
};

ASTROLITH_HD inline MetaballParameters<double> in_double(const MetaballParameters<float>& b) {
  const CompactKernel<float>& k = b.compact_kernel;
  return {b.m_a,
          b.m_b,
          b.inverse_m,
          b.log_iso,
          b.cutoff_squared,
          b.gradient_floor,
          {k.kernel, k.scale, k.low, k.height},
          b.m};
}

template <typename T>
struct MetaballSphere {
  Vec3<T> center{};
  T inverse_radius_squared{};  // negative for subtractive spheres

  ASTROLITH_HD bool subtractive() const { return inverse_radius_squared < T(0); }
  // This sphere as one that adds.
  ASTROLITH_HD MetaballSphere as_adding() const {
    return {center, subtractive() ? -inverse_radius_squared : inverse_radius_squared};
  }
};

// Running sums over spheres at one point.
template <typename T>
struct MetaballSums {
  T kernel{};          // sum_i exp k_i, or sum_i K_i^m for other kernels
  Vec3<T> weighted{};  // sum_i exp(k_i) (p - c_i) / r_i^2; sum_i K_i^m (-K_i'/K_i) (p - c_i) / r_i^2
};

template <typename T>
ASTROLITH_KERNEL void accumulate_gaussian(const MetaballParameters<T>& body, const MetaballSphere<T>& sphere,
                                          const Vec3<T>& p, MetaballSums<T>& sums) {
  const T dx = p.x - sphere.center.x;
  const T dy = p.y - sphere.center.y;
  const T dz = p.z - sphere.center.z;
  const T q = math::fma(dx, dx, math::fma(dy, dy, dz * dz)) * sphere.inverse_radius_squared;
  const T exponent = math::fma(-body.m_b, q, body.m_a);
  const T kernel = math::exp_within_range(exponent < T(kLargestExponent) ? exponent : T(kLargestExponent));
  const T value = q < body.cutoff_squared ? kernel : T(0);
  const T weight = value * sphere.inverse_radius_squared;
  sums.kernel += value;
  sums.weighted.x = math::fma(weight, dx, sums.weighted.x);
  sums.weighted.y = math::fma(weight, dy, sums.weighted.y);
  sums.weighted.z = math::fma(weight, dz, sums.weighted.z);
}

// Expects kernel == body.compact_kernel.kernel, not the Gaussian.
template <Kernel kernel, typename T>
ASTROLITH_KERNEL void accumulate_compact(const MetaballParameters<T>& body, const MetaballSphere<T>& sphere,
                                         const Vec3<T>& p, MetaballSums<T>& sums) {
  using math::exp;
  using math::log;
  const T dx = p.x - sphere.center.x;
  const T dy = p.y - sphere.center.y;
  const T dz = p.z - sphere.center.z;
  const T q = math::fma(dx, dx, math::fma(dy, dy, dz * dz)) * sphere.inverse_radius_squared;
  const T inside_support = q < body.cutoff_squared ? T(1) : T(0);
  const KernelDerivatives<T> k = kernel_value<kernel>(body.compact_kernel, q);
  const T positive = k.value > T(kLeastKernel) ? k.value : T(kLeastKernel);
  const T exponent = body.m * log(positive);
  const T value = inside_support * exp(exponent < T(kLargestExponent) ? exponent : T(kLargestExponent));
  const T weight = value / positive * k.slope * sphere.inverse_radius_squared;
  sums.kernel += value;
  sums.weighted.x = math::fma(weight, dx, sums.weighted.x);
  sums.weighted.y = math::fma(weight, dy, sums.weighted.y);
  sums.weighted.z = math::fma(weight, dz, sums.weighted.z);
}

// Adds a sphere to the sums, for any kernel.
template <typename T>
ASTROLITH_KERNEL void accumulate_metaball(const MetaballParameters<T>& body, const MetaballSphere<T>& sphere,
                                          const Vec3<T>& p, MetaballSums<T>& sums) {
  switch (body.compact_kernel.kernel) {
    case Kernel::kGaussian:
      return accumulate_gaussian(body, sphere, p, sums);
    case Kernel::kMetaball:
      return accumulate_compact<Kernel::kMetaball>(body, sphere, p, sums);
    case Kernel::kSoftObject:
      return accumulate_compact<Kernel::kSoftObject>(body, sphere, p, sums);
    case Kernel::kWyvill:
      return accumulate_compact<Kernel::kWyvill>(body, sphere, p, sums);
    case Kernel::kCauchy:
      return accumulate_compact<Kernel::kCauchy>(body, sphere, p, sums);
  }
}

// The sum A and the sum that gives its gradient, from the sums P and N.
template <typename T>
ASTROLITH_KERNEL MetaballSums<T> net_sums(const MetaballSums<T>& added, const MetaballSums<T>& subtracted) {
  const T part = T(1) / (T(1) + subtracted.kernel);
  const T kernel = added.kernel * part;
  const auto net = [&](T added_term, T subtracted_term) {
    return added_term * part - subtracted_term * part * kernel;
  };
  return {kernel,
          {net(added.weighted.x, subtracted.weighted.x), net(added.weighted.y, subtracted.weighted.y),
           net(added.weighted.z, subtracted.weighted.z)}};
}

// Running sums over the spheres that add and over the subtractive ones.
template <typename T>
struct MetaballTotals {
  MetaballSums<T> added, subtracted;

  ASTROLITH_HD MetaballSums<T> net() const { return net_sums(added, subtracted); }
};

template <typename T>
ASTROLITH_KERNEL void accumulate_metaball(const MetaballParameters<T>& body, const MetaballSphere<T>& sphere,
                                          const Vec3<T>& p, MetaballTotals<T>& totals) {
  if (sphere.subtractive()) {
    accumulate_metaball(body, sphere.as_adding(), p, totals.subtracted);
  } else {
    accumulate_metaball(body, sphere, p, totals.added);
  }
}

template <typename T>
struct SurfaceDistance {
  T distance{};            // s(p), positive inside
  Vec3<T> log_gradient{};  // grad L, or grad M: points inwards
};

template <typename T>
ASTROLITH_KERNEL SurfaceDistance<T> gaussian_distance(const MetaballParameters<T>& body,
                                                      const MetaballSums<T>& sums) {
  const T total = sums.kernel + T(kKernelFloor);
  const T log_field = math::log(total) * body.inverse_m - body.log_iso;
  const T factor = T(-2) * body.m_b * body.inverse_m / total;
  const Vec3<T> g{factor * sums.weighted.x, factor * sums.weighted.y, factor * sums.weighted.z};
  const T g2 = math::fma(g.x, g.x, math::fma(g.y, g.y, g.z * g.z));
  return {log_field / math::sqrt(g2 + body.gradient_floor), g};
}

// s and grad M for every kernel but the Gaussian.
template <typename T>
ASTROLITH_KERNEL SurfaceDistance<T> compact_distance(const MetaballParameters<T>& body,
                                                     const MetaballSums<T>& sums) {
  const T total = sums.kernel + T(kKernelFloor);
  const T norm = math::exp(math::log(total) * body.inverse_m);
  const T factor = T(-2) * norm / total;
  const Vec3<T> g{factor * sums.weighted.x, factor * sums.weighted.y, factor * sums.weighted.z};
  const T g2 = math::fma(g.x, g.x, math::fma(g.y, g.y, g.z * g.z));
  return {(norm - T(1)) / math::sqrt(g2 + body.gradient_floor), g};
}

template <typename T>
ASTROLITH_KERNEL SurfaceDistance<T> metaball_distance(const MetaballParameters<T>& body,
                                                      const MetaballSums<T>& sums) {
  return body.compact_kernel.kernel == Kernel::kGaussian ? gaussian_distance(body, sums)
                                                         : compact_distance(body, sums);
}

// f(q) = K(q)^m of one sphere: f, -df/dq and d^2f/dq^2 in double precision, for derivatives by the centre,
// the radius and the point. Where the value of the Gaussian saturates, its derivatives are m b and (m b)^2
// times the saturated value.
inline KernelDerivatives<double> kernel_power(const MetaballParameters<double>& body, double q) {
  if (!(q < body.cutoff_squared)) return {0.0, 0.0, 0.0};
  if (body.compact_kernel.kernel == Kernel::kGaussian) {
    const double f = portable::exp(std::min(body.m_a - body.m_b * q, double{kLargestExponent}));
    return {f, body.m_b * f, body.m_b * body.m_b * f};
  }
  const KernelDerivatives<double> k = kernel_value(body.compact_kernel, q);
  if (!(k.value > double{kLeastKernel})) return {0.0, 0.0, 0.0};
  const double lower = portable::pow(k.value, body.m - 1.0);
  return {lower * k.value, body.m * lower * k.slope,
          body.m * lower * ((body.m - 1.0) * k.slope * k.slope / k.value + k.curvature)};
}

}  // namespace astrolith
