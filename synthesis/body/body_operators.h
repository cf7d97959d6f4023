// Operators that combine two bodies (thesis 2.2), as functions of their signed distances f and g, positive
// inside. They are plain scalar code for float values and for bounds in double. Every operator is monotone in
// both operands, except for the bulge of Pasko's union.
//
// The R-functions (f + g +- sqrt(f^2 + g^2 - 2 alpha f g)) / (1 + alpha) have the exact surface. Away from it
// they are smoother for smaller alpha: alpha = 1 gives max and min, alpha = 0 the clean union (eq. 2.17).
#pragma once

#include "numerics/host_device.h"
#include "numerics/scalar_math.h"
#include "recipe/recipe.h"

namespace astrolith {

// The parameters of an operator. The kind decides which of them are used.
template <typename T>
struct OperatorParameters {
  Operator kind = Operator::kUnion;
  T alpha = T(1);
  T exponent{}, width{};                     // super-elliptic blend: n; width in length units
  T bulge{}, inverse_reach[2] = {T(), T()};  // Pasko's union: a0, 1/a1, 1/a2
};

template <typename T>
ASTROLITH_KERNEL T larger(T a, T b) {
  return a > b ? a : b;
}

// The R-function of the union. Where f + g < 0 it avoids the difference of nearly equal numbers.
template <typename T>
ASTROLITH_KERNEL T r_union(T f, T g, T alpha) {
  const T sum = f + g;
  const T square = math::fma(f, f, math::fma(g, g, T(-2) * alpha * (f * g)));
  const T root = math::sqrt(larger(square, T(0)));
  const T below = T(2) * f * (g / (sum < T(0) ? sum - root : T(-1)));
  return sum < T(0) ? below : (sum + root) / (T(1) + alpha);
}

// The super-elliptic blend width ((f'^n + g'^n)^(1/n) - 1) with f' = max(0, 1 + f / width) and n the
// exponent. It ends `width` outside of either body. The code adds the effect of the blend to the union max(f,
// g).
template <typename T>
ASTROLITH_KERNEL T super_elliptic(T f, T g, T exponent, T width) {
  const T high = larger(f, g), low = f > g ? g : f;
  const T a = larger(T(1) + high / width, T(0)), b = larger(T(1) + low / width, T(0));
  const T ratio = b / larger(a, T(1e-30));
  const T power = ratio > T(0) ? math::exp(exponent * math::log(larger(ratio, T(1e-30)))) : T(0);
  const T factor = math::exp(math::log(T(1) + power) / exponent);
  return high + width * a * (factor - T(1));
}

// The bulge of Pasko's union, a0 / (1 + (f/a1)^2 + (g/a2)^2), eq. 2.16.
template <typename T>
ASTROLITH_KERNEL T bulge(const OperatorParameters<T>& o, T f, T g) {
  const T u = f * o.inverse_reach[0], v = g * o.inverse_reach[1];
  return o.bulge / math::fma(u, u, math::fma(v, v, T(1)));
}

// The operator without the bulge, which is the only part that is not monotone in its operands.
template <typename T>
ASTROLITH_KERNEL T monotone_combined(const OperatorParameters<T>& o, T f, T g) {
  switch (o.kind) {
    case Operator::kIntersection:
      return -r_union(-f, -g, o.alpha);
    case Operator::kDifference:
      return -r_union(-f, g, o.alpha);
    case Operator::kBlend:
      return super_elliptic(f, g, o.exponent, o.width);
    case Operator::kCleanUnion:
      return r_union(f, g, T(0));
    default:
      return r_union(f, g, o.alpha);
  }
}

template <typename T>
ASTROLITH_KERNEL T combined(const OperatorParameters<T>& o, T f, T g) {
  const T monotone = monotone_combined(o, f, g);
  return o.kind == Operator::kCleanUnion ? monotone + bulge(o, f, g) : monotone;
}

// The signed distance of a body at a point, and the gradient of this distance, which has about unit length.
struct BodySample {
  float distance;
  float gx, gy, gz;
};

// The combination of two samples. Its gradient is the sum of the operands' gradients, weighted by the partial
// derivatives of the operator. Central differences with a step that suits floats give these derivatives.
ASTROLITH_KERNEL BodySample combined(const OperatorParameters<float>& o, const BodySample& a,
                                     const BodySample& b) {
  const float f = a.distance, g = b.distance;
  const float h = 1e-3f * larger(math::abs(f), math::abs(g)) + 1e-20f;
  const float first = (combined(o, f + h, g) - combined(o, f - h, g)) / (2.0f * h);
  const float second = (combined(o, f, g + h) - combined(o, f, g - h)) / (2.0f * h);
  return {combined(o, f, g), math::fma(first, a.gx, second * b.gx), math::fma(first, a.gy, second * b.gy),
          math::fma(first, a.gz, second * b.gz)};
}

}  // namespace astrolith
