// The metaball body as a smooth signed distance: plain scalar code shared by the float evaluation in blocks,
// the GPU, and the double-precision fit.
//
// With k_i(p) = m (a - b |p - c_i|^2 / r_i^2) the p-norm blend of thesis eq. 4.5 is a log-sum-exp,
//   log m(p) = L(p) = (1/m) log(sum_i exp k_i(p)),
// and the body is L >= log T. Near the surface the first-order distance to it is
//   s(p) = (L(p) - log T) / |grad L(p)|,     grad L = -2 b sum_i w_i (p - c_i) / r_i^2,  w = softmax(k),
// positive inside, in length units. Layers add heights to s, which is eq. 5.1 with every n_i multiplied by
// |grad m|: amplitudes are then lengths, the same beside a large sphere and a small one.
#pragma once

#include "numerics/host_device.h"
#include "numerics/scalar_math.h"
#include "numerics/vec3.h"

namespace astrolith {

// Added to the sum of kernels so that its logarithm stays finite where no kernel reaches: there s is a large
// negative number. e^-30 changes nothing where any kernel within its support contributes.
inline constexpr float kKernelFloor = 9.3576e-14f;

// Largest exponent of a kernel: deep inside sharp bodies the field saturates, so that float sums stay finite.
inline constexpr float kLargestExponent = 60.0f;

// Parameters of a body, ready for evaluation in scalar type T.
template <typename T>
struct MetaballParameters {
  T m_a{};             // m a
  T m_b{};             // m b
  T inverse_m{};       // 1 / m
  T log_iso{};         // log T
  T cutoff_squared{};  // squared support in radii
  T gradient_floor{};  // squared; keeps s finite where grad L vanishes, about (1e-3 / largest radius)^2
};

template <typename T>
struct MetaballSphere {
  Vec3<T> center{};
  T inverse_radius_squared{};
};

// Running sums over spheres at one point.
template <typename T>
struct MetaballSums {
  T kernel{};          // sum_i exp k_i
  Vec3<T> weighted{};  // sum_i exp(k_i) (p - c_i) / r_i^2
};

template <typename T>
ASTROLITH_KERNEL void accumulate_metaball(const MetaballParameters<T>& body, const MetaballSphere<T>& sphere,
                                          const Vec3<T>& p, MetaballSums<T>& sums) {
  using math::exp;
  const T dx = p.x - sphere.center.x;
  const T dy = p.y - sphere.center.y;
  const T dz = p.z - sphere.center.z;
  const T q = math::fma(dx, dx, math::fma(dy, dy, dz * dz)) * sphere.inverse_radius_squared;
  const T inside_support = q < body.cutoff_squared ? T(1) : T(0);
  const T exponent = math::fma(-body.m_b, q, body.m_a);
  const T value = inside_support * exp(exponent < T(kLargestExponent) ? exponent : T(kLargestExponent));
  const T weight = value * sphere.inverse_radius_squared;
  sums.kernel += value;
  sums.weighted.x = math::fma(weight, dx, sums.weighted.x);
  sums.weighted.y = math::fma(weight, dy, sums.weighted.y);
  sums.weighted.z = math::fma(weight, dz, sums.weighted.z);
}

template <typename T>
struct SurfaceDistance {
  T distance{};            // s(p), positive inside
  Vec3<T> log_gradient{};  // grad L: points inwards
};

template <typename T>
ASTROLITH_KERNEL SurfaceDistance<T> metaball_distance(const MetaballParameters<T>& body,
                                                      const MetaballSums<T>& sums) {
  const T total = sums.kernel + T(kKernelFloor);
  const T log_field = math::log(total) * body.inverse_m - body.log_iso;
  const T factor = T(-2) * body.m_b * body.inverse_m / total;
  const Vec3<T> g{factor * sums.weighted.x, factor * sums.weighted.y, factor * sums.weighted.z};
  const T g2 = math::fma(g.x, g.x, math::fma(g.y, g.y, g.z * g.z));
  return {log_field / math::sqrt(g2 + body.gradient_floor), g};
}

}  // namespace astrolith
