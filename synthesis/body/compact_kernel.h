// The kernels of thesis 2.1 other than the Gaussian, as functions of the squared distance. They are plain
// scalar code for the float evaluation, the GPU and fits in double precision.
//
//   K(q) = height (k(scale q) - low) for q below the cut-off, else 0,     q = |p - c|^2 / r^2
//
// Here k has unit height and, except for Cauchy's kernel, unit support:
//
//   metaball (eq. 2.6)     k(x) = 1 - 3x for x <= 1/9, 3/2 (1 - sqrt x)^2 for x <= 1
//   soft object (eq. 2.7)  k(x) = (1 - x)^2 (1 - 4x/9) = 1 - 22/9 x + 17/9 x^2 - 4/9 x^3
//   Wyvill (eq. 2.8)       k(x) = (1 - x)^3
//   Cauchy (eq. 2.9)       k(x) = 1 / (1 + x)
//
// `low` is the value of k at the cut-off, so that K is continuous there.
#pragma once

#include "numerics/host_device.h"
#include "numerics/scalar_math.h"
#include "recipe/recipe.h"

namespace astrolith {

// A kernel and its derivatives: k(x), -k'(x) >= 0 and k''(x).
template <typename T>
struct KernelDerivatives {
  T value, slope, curvature;
};

template <Kernel kernel, typename T>
ASTROLITH_KERNEL KernelDerivatives<T> unit_kernel(T x) {
  const T rest = x < T(1) ? T(1) - x : T(0);
  if constexpr (kernel == Kernel::kMetaball) {
    const bool core = x < T(1) / T(9);
    const T t = math::sqrt(core ? T(1) / T(9) : x), left = t < T(1) ? T(1) - t : T(0);
    return {core ? T(1) - T(3) * x : T(1.5) * left * left, core ? T(3) : T(1.5) * left / t,
            core ? T(0) : T(0.75) / (t * t * t)};
  } else if constexpr (kernel == Kernel::kSoftObject) {
    constexpr T kNinth = T(1) / T(9);
    return {rest * rest * (T(1) - T(4) * kNinth * x), rest * kNinth * (T(22) - T(12) * x),
            kNinth * (T(34) - T(24) * x)};
  } else if constexpr (kernel == Kernel::kWyvill) {
    return {rest * rest * rest, T(3) * rest * rest, T(6) * rest};
  } else {
    static_assert(kernel == Kernel::kCauchy);
    const T k = T(1) / (T(1) + x);
    return {k, k * k, T(2) * k * k * k};
  }
}

// The kind of a kernel and its scaling.
template <typename T>
struct CompactKernel {
  Kernel kernel = Kernel::kGaussian;
  T scale{}, low{}, height{};
};

// K(q), -dK/dq and d^2K/dq^2.
template <Kernel kernel, typename T>
ASTROLITH_KERNEL KernelDerivatives<T> kernel_value(const CompactKernel<T>& compact_kernel, T q) {
  const KernelDerivatives<T> k = unit_kernel<kernel>(q * compact_kernel.scale);
  const T per_q = compact_kernel.height * compact_kernel.scale;
  return {compact_kernel.height * (k.value - compact_kernel.low), per_q * k.slope,
          per_q * compact_kernel.scale * k.curvature};
}

// kernel_value() for a kernel that is known at run time only. Expects any kernel but the Gaussian.
template <typename T>
ASTROLITH_KERNEL KernelDerivatives<T> kernel_value(const CompactKernel<T>& compact_kernel, T q) {
  switch (compact_kernel.kernel) {
    case Kernel::kMetaball:
      return kernel_value<Kernel::kMetaball>(compact_kernel, q);
    case Kernel::kSoftObject:
      return kernel_value<Kernel::kSoftObject>(compact_kernel, q);
    case Kernel::kWyvill:
      return kernel_value<Kernel::kWyvill>(compact_kernel, q);
    default:
      return kernel_value<Kernel::kCauchy>(compact_kernel, q);
  }
}

// Returns a kernel K with K(0) = e^tension and K(surface) = 1 that ends at `cutoff_squared` or before. Sets
// `cutoff_squared` to its end. Expects 0 < surface < cutoff_squared and e^-tension < 1 - surface /
// cutoff_squared, as validation does. The latter bound belongs to the flattest kernel with this end.
CompactKernel<double> scaled_kernel(Kernel kernel, double tension, double surface, double& cutoff_squared);

}  // namespace astrolith
