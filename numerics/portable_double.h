// Exponential, logarithm and power of doubles with the same bits on every CPU and every GPU, for bounds that
// the CPU and the GPU must agree upon. They are polynomials of products and sums, of which nothing is
// contracted. fma is avoided because it is a function call in programs built for every x86-64. Points are
// evaluated in float (scalar_math.h).
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "numerics/host_device.h"

namespace astrolith::portable {

ASTROLITH_HD inline std::int64_t bits_of(double x) {
#ifdef __CUDA_ARCH__
  return __double_as_longlong(x);
#else
  return std::bit_cast<std::int64_t>(x);
#endif
}
ASTROLITH_HD inline double double_of(std::int64_t bits) {
#ifdef __CUDA_ARCH__
  return __longlong_as_double(bits);
#else
  return std::bit_cast<double>(bits);
#endif
}

// ln 2 in two parts, so that whole multiples of the first are exact (Cody and Waite).
inline constexpr double kLn2High = 6.93147180369123816490e-01, kLn2Low = 1.90821492927058770002e-10;

// e^x within 2e-15 of itself for x in [-708, 709]; 0 below, the value at 709 above.
ASTROLITH_HD inline double exp(double x) {
  const double clamped = x < -708.0 ? -708.0 : x > 709.0 ? 709.0 : x;
  const double n = std::floor(clamped * 1.44269504088896340736 + 0.5);
  const double r = (clamped - n * kLn2High) - n * kLn2Low;
  // Taylor coefficients 1/k!; |r| <= ln(2)/2 leaves a remainder below 5e-18.
  double p = 1.0 / 6227020800.0;
  p = p * r + 1.0 / 479001600.0;
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
  p = p * r + 1.0;
  // The power of two is applied in two factors, so that neither factor leaves the range of doubles (2^1024
  // does).
  const auto whole = static_cast<std::int64_t>(n);
  const std::int64_t half = whole / 2;
  const double scaled = p * double_of((half + 1023) << 52) * double_of((whole - half + 1023) << 52);
  return x < -708.0 ? 0.0 : scaled;
}

// Natural logarithm of a normal positive x, with an error of at most 2e-15, absolute near 1 and relative
// elsewhere. Smaller x, zero and negative x give about -708.4.
ASTROLITH_HD inline double log(double x) {
  const double normal = x > 2.2250738585072014e-308 ? x : 2.2250738585072014e-308;
  const std::int64_t i = bits_of(normal);
  // Exponent such that the mantissa lies in [sqrt(1/2), sqrt(2)).
  const std::int64_t e = (i - 0x3fe6a09e667f3bcd) >> 52;
  const double m = double_of(i - e * (std::int64_t{1} << 52));
  // log(m) = 2 atanh(s), |s| <= 0.172; the series leaves a remainder below 1e-18.
  const double s = (m - 1.0) / (m + 1.0), z = s * s;
  double p = 1.0 / 23.0;
  p = p * z + 1.0 / 21.0;
  p = p * z + 1.0 / 19.0;
  p = p * z + 1.0 / 17.0;
  p = p * z + 1.0 / 15.0;
  p = p * z + 1.0 / 13.0;
  p = p * z + 1.0 / 11.0;
  p = p * z + 1.0 / 9.0;
  p = p * z + 1.0 / 7.0;
  p = p * z + 1.0 / 5.0;
  p = p * z + 1.0 / 3.0;
  const double k = static_cast<double>(e);
  const double tail = 2.0 * s * z * p;
  return k * kLn2High + (k * kLn2Low + (tail + 2.0 * s));
}

// x^y for x >= 0 and finite y, within |y log x| * 1e-15 of itself; x^0 is 1.
ASTROLITH_HD inline double pow(double x, double y) {
  if (y == 0.0) return 1.0;
  return x > 0.0 ? exp(y * log(x)) : 0.0;
}

}  // namespace astrolith::portable
