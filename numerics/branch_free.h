// Logarithm and arc tangent of doubles without branches, for loops that a compiler is to vectorise. The bits
// are the same for every vector width: products, sums and quotients only, of which nothing is contracted.
// portable_double.h and portable_angles.h have versions for one number at a time.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "numerics/host_device.h"
#include "numerics/portable_angles.h"
#include "numerics/portable_double.h"

namespace astrolith::branch_free {

// log((sum + difference) / (sum - difference)) without loss of digits, for 0 <= difference <= sum. The caller
// gives the same quotient as `above` / `below`, both >= 0 and free of cancellation. It is used where it is
// above sqrt(2); below that the series of the inverse hyperbolic tangent takes difference / sum. The error is
// at most 2 ulp of the logarithm. Quotients are limited to 1e290, so that below = 0 gives a finite number.
ASTROLITH_KERNEL double log_ratio(double above, double below, double difference, double sum) {
  constexpr double kTiny = 1e-290, kHuge = 1e290;
  const double quotient = above / (below > kTiny ? below : kTiny);
  const double at_least_one = quotient > 1.0 ? quotient : 1.0;
  const double q = at_least_one < kHuge ? at_least_one : kHuge;
  // q = 2^exponent * mantissa, mantissa in [sqrt(1/2), sqrt(2)); the exponent becomes a double by its bits.
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(q);
  const std::uint64_t exponent = (bits - 0x3fe6a09e667f3bcdu) >> 52;
  const double mantissa = std::bit_cast<double>(bits - (exponent << 52));
  const double k = std::bit_cast<double>(exponent | 0x4330000000000000u) - 4503599627370496.0;
  const bool near_one = exponent == 0;
  const double divisor = sum > kTiny ? sum : kTiny;
  const double s = (near_one ? difference : mantissa - 1.0) / (near_one ? divisor : mantissa + 1.0),
               z = s * s;
  // |s| <= 0.172 leaves a remainder below 1e-17 of s.
  return k * portable::kLn2High + (k * portable::kLn2Low + portable::atanh_series(1.0 / 21.0, s, z));
}

// The angle of the point (x, y) in [-pi, pi]; 0 at the origin. The error is at most 2 ulp, or 1e-290 where
// that is more. Zeros have no sign: points on the negative x axis have the angle pi.
ASTROLITH_KERNEL double atan2(double y, double x) {
  constexpr double kTangent = 0.41421356237309504880, kPi = 3.14159265358979323846;  // tan(pi / 8)
  const double a = std::fabs(x), b = std::fabs(y);
  const double low = a < b ? a : b, high = a < b ? b : a;
  const bool third = low > 0.66817863791929891999 * high, second = low > 0.2553 * high;
  const double c = third ? 1.0 : second ? kTangent : 0.0;
  const double begin = third ? kPi / 4 : second ? kPi / 8 : 0.0;
  const double under = high + c * low;
  const double u = (low - c * high) / (under > 1e-290 ? under : 1e-290), z = u * u;
  // Taylor; |u| <= 0.2553 leaves a remainder below 1e-17 of u.
  const double octant = begin + portable::atan_series((-1.0 / 27.0 * z + 1.0 / 25.0) * z - 1.0 / 23.0, u, z);
  const double quadrant = a < b ? kPi / 2 - octant : octant;
  const double half = x < 0.0 ? kPi - quadrant : quadrant;
  return y < 0.0 ? -half : half;
}

}  // namespace astrolith::branch_free
