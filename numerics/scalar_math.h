// Elementary functions of one float with the same bits on every CPU, every vector width and every GPU. They
// are our own polynomials with explicit fma and without branches or tables, so that compilers vectorise loops
// over them. The double overloads are those of portable_double.h and portable_angles.h.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "numerics/emulated_fma.h"
#include "numerics/host_device.h"
#include "numerics/portable_angles.h"
#include "numerics/portable_double.h"

namespace astrolith::math {

ASTROLITH_HD inline std::int32_t to_bits(float x) {
#ifdef __CUDA_ARCH__
  return __float_as_int(x);
#else
  return std::bit_cast<std::int32_t>(x);
#endif
}

ASTROLITH_HD inline float from_bits(std::int32_t bits) {
#ifdef __CUDA_ARCH__
  return __int_as_float(bits);
#else
  return std::bit_cast<float>(bits);
#endif
}

// a*b + c with one rounding.
ASTROLITH_HD inline float fma(float a, float b, float c) {
#ifdef __CUDA_ARCH__
  return __fmaf_rn(a, b, c);
#elif defined(__wasm__)
  return emulated_fma(a, b, c);
#else
  return __builtin_fmaf(a, b, c);
#endif
}
ASTROLITH_HD inline double fma(double a, double b, double c) { return std::fma(a, b, c); }

// IEEE square root, correctly rounded.
ASTROLITH_HD inline float sqrt(float x) {
#ifdef __CUDA_ARCH__
  return __fsqrt_rn(x);
#else
  return __builtin_sqrtf(x);
#endif
}
ASTROLITH_HD inline double sqrt(double x) { return std::sqrt(x); }

ASTROLITH_HD inline float abs(float x) { return from_bits(to_bits(x) & 0x7fffffff); }
ASTROLITH_HD inline float min(float a, float b) { return a < b ? a : b; }
ASTROLITH_HD inline float max(float a, float b) { return a > b ? a : b; }
ASTROLITH_HD inline float clamp(float x, float lo, float hi) { return min(max(x, lo), hi); }

// The nearest integer as a float, ties to even, for |x| < 2^22. Adding 1.5 * 2^23 leaves no bits for a
// fraction. This also works where the baseline instruction set has no rounding instruction.
ASTROLITH_HD inline float round_even(float x) {
  constexpr float kMagic = 12582912.0f;
  return (x + kMagic) - kMagic;
}

// Largest integer not above x, as a float; one instruction where the machine has it.
ASTROLITH_HD inline float floor(float x) {
#ifdef __CUDA_ARCH__
  return floorf(x);
#else
  return __builtin_floorf(x);
#endif
}

// The terms r^k / k! of e^r up to k = 7; |r| <= ln(2)/2 leaves a remainder below 2e-8.
ASTROLITH_KERNEL float exp_series(float r) {
  float p = 1.0f / 5040.0f;
  p = fma(p, r, 1.0f / 720.0f);
  p = fma(p, r, 1.0f / 120.0f);
  p = fma(p, r, 1.0f / 24.0f);
  p = fma(p, r, 1.0f / 6.0f);
  p = fma(p, r, 0.5f);
  p = fma(p, r, 1.0f);
  return fma(p, r, 1.0f);
}

// e^x within 2 ulp for x in [-87, 88]; 0 below -87, the value at 88 above.
ASTROLITH_KERNEL float exp(float x) {
  const float clamped = clamp(x, -87.0f, 88.0f);
  const float n = round_even(clamped * 1.44269504088896341f);
  // ln 2 in two parts, so that the reduced argument keeps all its bits (Cody and Waite).
  const float r = fma(n, -1.42860677e-6f, fma(n, -0.693145751953125f, clamped));
  const float scale = from_bits((static_cast<std::int32_t>(n) + 127) << 23);
  return x < -87.0f ? 0.0f : exp_series(r) * scale;
}
ASTROLITH_HD inline double exp(double x) { return portable::exp(x); }

// e^x with the bits of exp(x) for x in [-87, 88], at a lower cost; any float for other x.
ASTROLITH_KERNEL float exp_within_range(float x) {
  constexpr float kMagic = 12582912.0f;  // as in round_even(): the last bits of the sum are the integer
  const float shifted = x * 1.44269504088896341f + kMagic;
  const float n = shifted - kMagic;
  const float r = fma(n, -1.42860677e-6f, fma(n, -0.693145751953125f, x));
  const auto power = static_cast<std::uint32_t>(to_bits(shifted)) + 127u;
  return exp_series(r) * from_bits(static_cast<std::int32_t>(power << 23));
}
ASTROLITH_HD inline double exp_within_range(double x) { return portable::exp(x); }

// Natural logarithm within 2 ulp for normal positive x; about -87.3 for zero and subnormals.
ASTROLITH_KERNEL float log(float x) {
  const float normal = max(x, 1.17549435e-38f);
  const std::int32_t i = to_bits(normal);
  // Exponent such that the mantissa lies in [sqrt(1/2), sqrt(2)).
  const std::int32_t e = (i - 0x3f3504f3) >> 23;
  const float m = from_bits(i - (e << 23));
  const float f = m - 1.0f;
  // log(m) = 2 atanh(s), s = f / (2 + f), |s| <= 0.172.
  const float s = f / (2.0f + f);
  const float z = s * s;
  float p = 2.0f / 9.0f;
  p = fma(p, z, 2.0f / 7.0f);
  p = fma(p, z, 2.0f / 5.0f);
  p = fma(p, z, 2.0f / 3.0f);
  const float tail = s * z * p;
  const float k = static_cast<float>(e);
  // log(m) = 2 s + tail with 2 s = f - s f, written so that f keeps its bits next to the small corrections.
  const float log_m = f - (s * f - tail);
  return fma(k, 0.693145751953125f, fma(k, 1.42860677e-6f, log_m));
}
ASTROLITH_HD inline double log(double x) { return portable::log(x); }

// sin(2 pi x) for |x| < 2^22, with an absolute error below 2e-7. Arguments in turns need no
// multiple-precision reduction.
ASTROLITH_HD inline float sin_turns(float x) {
  const float r = x - round_even(x);  // [-1/2, 1/2]
  // Fold to [-1/4, 1/4] with sin(pi - t) = sin t.
  const float a = abs(r);
  const float folded = a > 0.25f ? 0.5f - a : a;
  const float y = r < 0.0f ? -folded : folded;
  const float t = y * 6.28318530717958648f;
  const float z = t * t;
  float p = -2.50521084e-8f;  // Taylor: -1/11!
  p = fma(p, z, 2.75573192e-6f);
  p = fma(p, z, -1.98412698e-4f);
  p = fma(p, z, 8.33333333e-3f);
  p = fma(p, z, -1.66666667e-1f);
  return fma(t * z, p, t);
}
ASTROLITH_HD inline double sin_turns(double x) {
  return portable::sin(6.283185307179586476925 * (x - std::round(x)));
}

// cos(2 pi x) = 1 - 2 sin^2(pi x) for |x| < 2^22, with an absolute error below 7e-7. This form has no
// quadrants to fold, and pays with four times the error of the sine.
ASTROLITH_HD inline float cos_turns(float x) {
  const float r = x - round_even(x);  // [-1/2, 1/2]
  const float z = r * r;
  float p = 7.76559123e-2f;  // Chebyshev: sin(pi r) / r over z in [0, 1/4], within 2e-8
  p = fma(p, z, -5.98290411e-1f);
  p = fma(p, z, 2.55007739f);
  p = fma(p, z, -5.16771008f);
  p = fma(p, z, 3.14159264f);
  const float s = r * p;
  return fma(-2.0f * s, s, 1.0f);
}
ASTROLITH_HD inline double cos_turns(double x) {
  return portable::cos(6.283185307179586476925 * (x - std::round(x)));
}

// atan2(y, x) / (2 pi), in [-1/2, 1/2], for finite arguments; 0 where both are 0. Absolute error < 5e-8.
ASTROLITH_HD inline float atan2_turns(float y, float x) {
  const float a = abs(x), b = abs(y);
  const float t = min(a, b) / max(max(a, b), 1e-37f);
  const float z = t * t;
  float p = -2.77518663e-4f;  // Chebyshev: atan(t) / (2 pi t) over t^2 in [0, 1]
  p = fma(p, z, 1.69988933e-3f);
  p = fma(p, z, -4.88884344e-3f);
  p = fma(p, z, 9.14560934e-3f);
  p = fma(p, z, -1.33245536e-2f);
  p = fma(p, z, 1.74118674e-2f);
  p = fma(p, z, -2.26979995e-2f);
  p = fma(p, z, 3.18281726e-2f);
  p = fma(p, z, -5.30515665e-2f);
  p = fma(p, z, 1.59154943e-1f);
  const float octant = p * t;
  const float quadrant = b > a ? 0.25f - octant : octant;
  const float half = x < 0.0f ? 0.5f - quadrant : quadrant;
  return y < 0.0f ? -half : half;
}

}  // namespace astrolith::math
