// Exponential, logarithms, powers and the cube root of doubles with the same bits on every CPU and every GPU.
// The last bits of the C library's functions differ between its versions and between processors. These
// functions are polynomials of products and sums, of which nothing is contracted. fma is avoided because it
// is a function call in programs built for every x86-64. Points are evaluated in float (scalar_math.h);
// angles have portable_angles.h.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "numerics/host_device.h"

namespace astrolith::portable {

ASTROLITH_HD inline std::int64_t to_bits(double x) {
#ifdef __CUDA_ARCH__
  return __double_as_longlong(x);
#else
  return std::bit_cast<std::int64_t>(x);
#endif
}
ASTROLITH_HD inline double from_bits(std::int64_t bits) {
#ifdef __CUDA_ARCH__
  return __longlong_as_double(bits);
#else
  return std::bit_cast<double>(bits);
#endif
}

// ln 2 in two parts, so that whole multiples of the first are exact (Cody and Waite).
inline constexpr double kLn2High = 6.93147180369123816490e-01, kLn2Low = 1.90821492927058770002e-10;

// The first twelve terms of e^r, r^k / k!, where `p` is the sum of those from r^12 on over r^12.
ASTROLITH_KERNEL double exp_series(double p, double r) {
  p = p * r + 1.0 / 39916800.0;
  p = p * r + 1.0 / 3628800.0;
  p = p * r + 1.0 / 362880.0;
  p = p * r + 1.0 / 40320.0;
  p = p * r + 1.0 / 5040.0;
  p = p * r + 1.0 / 720.0;
  p = p * r + 1.0 / 120.0;
  p = p * r + 1.0 / 24.0;
  p = p * r + 1.0 / 6.0;
  p = p * r + 0.5;
  p = p * r + 1.0;
  return p * r + 1.0;
}

// 2 atanh(s), which is log((1 + s) / (1 - s)). With z = s^2, `p` is the sum of the terms z^k / (2 k + 1) from
// k = 10 on over z^10.
ASTROLITH_KERNEL double atanh_series(double p, double s, double z) {
  p = p * z + 1.0 / 19.0;
  p = p * z + 1.0 / 17.0;
  p = p * z + 1.0 / 15.0;
  p = p * z + 1.0 / 13.0;
  p = p * z + 1.0 / 11.0;
  p = p * z + 1.0 / 9.0;
  p = p * z + 1.0 / 7.0;
  p = p * z + 1.0 / 5.0;
  p = p * z + 1.0 / 3.0;
  return 2.0 * s * z * p + 2.0 * s;
}

// e^x within 2e-15 of itself for x in [-708, 709]; 0 below, the value at 709 above.
ASTROLITH_HD inline double exp(double x) {
  const double clamped = x < -708.0 ? -708.0 : x > 709.0 ? 709.0 : x;
  const double n = std::floor(clamped * 1.44269504088896340736 + 0.5);
  const double r = (clamped - n * kLn2High) - n * kLn2Low;
  // Taylor coefficients 1/k!; |r| <= ln(2)/2 leaves a remainder below 5e-18.
  const double p = exp_series(1.0 / 6227020800.0 * r + 1.0 / 479001600.0, r);
  // The power of two is applied in two factors, so that neither factor leaves the range of doubles (2^1024
  // does).
  const auto whole = static_cast<std::int64_t>(n);
  const std::int64_t half = whole / 2;
  const double scaled = p * from_bits((half + 1023) << 52) * from_bits((whole - half + 1023) << 52);
  return x < -708.0 ? 0.0 : scaled;
}

// A normal positive number is 2^exponent * mantissa with a mantissa in [sqrt(1/2), sqrt(2)).
struct BinaryParts {
  double exponent, log_mantissa;  // the natural logarithm of the mantissa
};

ASTROLITH_HD inline BinaryParts binary_parts(double x) {
  const double normal = x > 2.2250738585072014e-308 ? x : 2.2250738585072014e-308;
  const std::int64_t i = to_bits(normal);
  const std::int64_t e = (i - 0x3fe6a09e667f3bcd) >> 52;
  const double m = from_bits(i - e * (std::int64_t{1} << 52));
  // log(m) = 2 atanh(s), |s| <= 0.172; the series leaves a remainder below 1e-18.
  const double s = (m - 1.0) / (m + 1.0), z = s * s;
  return {static_cast<double>(e), atanh_series(1.0 / 23.0 * z + 1.0 / 21.0, s, z)};
}

// Natural logarithm of a normal positive x, with an error of at most 2e-15, absolute near 1 and relative
// elsewhere. Smaller x, zero and negative x give about -708.4.
ASTROLITH_HD inline double log(double x) {
  const BinaryParts parts = binary_parts(x);
  return parts.exponent * kLn2High + (parts.exponent * kLn2Low + parts.log_mantissa);
}

// Binary logarithm with the same limits as log; exact for powers of two.
ASTROLITH_HD inline double log2(double x) {
  const BinaryParts parts = binary_parts(x);
  return parts.exponent + parts.log_mantissa * 1.44269504088896340736;
}

// log(1 + x) for x > -1, within 1e-15 of itself.
ASTROLITH_HD inline double log1p(double x) {
  // The rounding of 1 + x is made good by the slope of the logarithm (Kahan); only where the sum is 1 does
  // nothing else than x remain.
  const double sum = 1.0 + x;
  return sum == 1.0 ? x : log(sum) - ((sum - 1.0) - x) / sum;
}

// x^y for x >= 0 and finite y, within |y log x| * 1e-15 of itself; x^0 is 1.
ASTROLITH_HD inline double pow(double x, double y) {
  if (y == 0.0) return 1.0;
  return x > 0.0 ? exp(y * log(x)) : 0.0;
}

// x^n for any x and n >= 0, within n ulp.
ASTROLITH_HD inline double whole_power(double x, int n) {
  double power = 1.0;
  for (int i = 0; i < n; ++i) power *= x;
  return power;
}

// The cube root within 4e-16 of itself, of any sign; 0 for subnormal x.
ASTROLITH_HD inline double cbrt(double x) {
  const double size = std::fabs(x);
  if (size < 2.2250738585072014e-308) return 0.0;
  const double root = exp(log(size) / 3.0);
  const double better = root - (root - size / (root * root)) / 3.0;  // one step of Newton
  return x < 0.0 ? -better : better;
}

}  // namespace astrolith::portable
