// Sine, cosine, tangent and arc tangent of doubles with the same bits on every CPU and every GPU. They are
// polynomials of products and sums, of which nothing is contracted. Angles are in radians.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "numerics/host_device.h"

namespace astrolith::portable {

struct SineCosine {
  double sine, cosine;
};

// Both within 4e-16 of the truth for |angle| <= 1e5.
ASTROLITH_HD inline SineCosine sine_and_cosine(double angle) {
  // pi / 2 in three parts, so that whole multiples of the first two are exact (Cody and Waite).
  constexpr double kFirst = 1.57079632673412561417e+00, kSecond = 6.07710050630396597660e-11,
                   kThird = 2.02226624879595063154e-21;
  const double quarters = std::floor(angle * (2.0 / std::numbers::pi) + 0.5);
  const double r = ((angle - quarters * kFirst) - quarters * kSecond) - quarters * kThird, z = r * r;
  // Taylor coefficients; |r| <= pi/4 leaves remainders below 1e-19.
  double p = 1.0 / 355687428096000.0;
  p = p * z - 1.0 / 1307674368000.0;
  p = p * z + 1.0 / 6227020800.0;
  p = p * z - 1.0 / 39916800.0;
  p = p * z + 1.0 / 362880.0;
  p = p * z - 1.0 / 5040.0;
  p = p * z + 1.0 / 120.0;
  p = p * z - 1.0 / 6.0;
  const double sine = r + r * z * p;
  double q = -1.0 / 6402373705728000.0;
  q = q * z + 1.0 / 20922789888000.0;
  q = q * z - 1.0 / 87178291200.0;
  q = q * z + 1.0 / 479001600.0;
  q = q * z - 1.0 / 3628800.0;
  q = q * z + 1.0 / 40320.0;
  q = q * z - 1.0 / 720.0;
  q = q * z + 1.0 / 24.0;
  const double cosine = 1.0 - (0.5 * z - z * z * q);
  switch (static_cast<std::int64_t>(quarters) & 3) {
    case 0:
      return {sine, cosine};
    case 1:
      return {cosine, -sine};
    case 2:
      return {-sine, -cosine};
    default:
      return {-cosine, sine};
  }
}

ASTROLITH_HD inline double sin(double angle) { return sine_and_cosine(angle).sine; }
ASTROLITH_HD inline double cos(double angle) { return sine_and_cosine(angle).cosine; }

// Within 1e-15 of itself for |angle| <= 1.56, which is 89.4 degrees.
ASTROLITH_HD inline double tan(double angle) {
  const SineCosine both = sine_and_cosine(angle);
  return both.sine / both.cosine;
}

// atan(u). With z = u^2, `p` is the sum of the terms (-z)^k / (2 k + 1) from k = 11 on over z^11.
ASTROLITH_KERNEL double atan_series(double p, double u, double z) {
  p = p * z + 1.0 / 21.0;
  p = p * z - 1.0 / 19.0;
  p = p * z + 1.0 / 17.0;
  p = p * z - 1.0 / 15.0;
  p = p * z + 1.0 / 13.0;
  p = p * z - 1.0 / 11.0;
  p = p * z + 1.0 / 9.0;
  p = p * z - 1.0 / 7.0;
  p = p * z + 1.0 / 5.0;
  p = p * z - 1.0 / 3.0;
  return u + u * z * p;
}

// atan(t) for t in [0, 1], within 3e-16.
ASTROLITH_HD inline double atan_unit_interval(double t) {
  // atan(t) = atan(c) + atan((t - c) / (1 + t c)), where c is the tangent of a multiple of pi/8. What is left
  // is at most tan(pi/16) = 0.199.
  constexpr double kTangent = 0.41421356237309504880;  // of pi/8
  const double c = t > 0.66817863791929891999 ? 1.0 : t > 0.19891236737965800691 ? kTangent : 0.0;
  const double begin = c == 1.0 ? std::numbers::pi / 4.0 : c > 0.0 ? std::numbers::pi / 8.0 : 0.0;
  const double u = (t - c) / (1.0 + t * c), z = u * u;
  return begin + atan_series(-1.0 / 23.0, u, z);  // Taylor; leaves a remainder below 2e-19
}

// The angle of the point (x, y) in [-pi, pi], within 1e-15; 0 at the origin. Zeros have no sign here: points
// on the negative x axis have the angle pi.
ASTROLITH_HD inline double atan2(double y, double x) {
  const double a = std::fabs(x), b = std::fabs(y);
  if (a == 0.0 && b == 0.0) return 0.0;
  const double octant =
      b > a ? std::numbers::pi / 2.0 - atan_unit_interval(a / b) : atan_unit_interval(b / a);
  const double half = x < 0.0 ? std::numbers::pi - octant : octant;
  return y < 0.0 ? -half : half;
}

}  // namespace astrolith::portable
