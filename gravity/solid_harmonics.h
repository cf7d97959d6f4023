// Solid harmonics without square roots:
//   R_lm = r^l P_lm(cos t) e^(i m f) / (l + m)!   and   S_lm = (l - m)! P_lm(cos t) e^(i m f) / r^(l + 1),
// with the sign of Condon and Shortley. For |y| < |x|
//   1 / |x - y| = sum over l, m of conj(R_lm(y)) S_lm(x),   R_lm(a + b) = sum R_jk(a) R_(l-j)(m-k)(b).
// (Hobson 1931; the scaling is that of White & Head-Gordon 1994.) Their integrals over facets use Gauss'
// rules on an interval and on a triangle.
#pragma once

#include <array>
#include <vector>

#include "numerics/vec3.h"

namespace astrolith {

struct TrianglePoint {
  double b, c, weight;  // the point a + b (B - a) + c (C - a) of a triangle a, B, C; the weights sum to one
};

// A rule that is exact for polynomials of this degree on a triangle, degree in [0, 100].
std::vector<TrianglePoint> triangle_rule(int degree);

constexpr int kMostOrder = 10;
constexpr int kHarmonics = (kMostOrder + 1) * (kMostOrder + 2) / 2;

// The index of l, m among the stored ones, 0 <= m <= l <= kMostOrder. All l of one m follow each other.
constexpr int harmonic_index(int l, int m) { return m * (kMostOrder + 1) - m * (m - 1) / 2 + (l - m); }

struct HarmonicValue {
  double re = 0.0, im = 0.0;
};
inline HarmonicValue& operator+=(HarmonicValue& a, const HarmonicValue& b) {
  a.re += b.re;
  a.im += b.im;
  return a;
}
inline HarmonicValue operator*(const HarmonicValue& a, const HarmonicValue& b) {
  return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

using Harmonics = std::array<HarmonicValue, kHarmonics>;

// Calls visit(l, R_lm(y)) for l = m .. last, where R_mm(y) is given. Multiples of R_mm give multiples of all.
template <typename Visit>
inline void visit_harmonics(const Vec3d& y, int m, int last, const HarmonicValue& diagonal,
                            const Visit& visit) {
  const double square = squared_norm(y);
  HarmonicValue before{}, now = diagonal;
  visit(m, now);
  for (int l = m + 1; l <= last; ++l) {
    const double scale = 1.0 / ((l + m) * (l - m)), up = (2 * l - 1) * y.z * scale, down = square * scale;
    const HarmonicValue next{up * now.re - down * before.re, up * now.im - down * before.im};
    before = now;
    visit(l, now = next);
  }
}

// R_lm(y) for l <= order; the others are left as they are. order in [0, kMostOrder].
inline void regular_harmonics(const Vec3d& y, int order, Harmonics& r) {
  HarmonicValue diagonal{1.0, 0.0};
  for (int m = 0; m <= order; ++m) {
    if (m > 0) {
      const double c = -0.5 / m;
      diagonal = HarmonicValue{c * y.x, c * y.y} * diagonal;
    }
    visit_harmonics(y, m, order, diagonal, [&](int l, const HarmonicValue& value) {
      r[static_cast<std::size_t>(harmonic_index(l, m))] = value;
    });
  }
}

// One coefficient of any sign of m, by X_l(-m) = (-1)^m conj(X_lm).
inline HarmonicValue signed_harmonic(const HarmonicValue* x, int l, int m) {
  if (m >= 0) return x[harmonic_index(l, m)];
  const HarmonicValue c = x[harmonic_index(l, -m)];
  return m % 2 == 0 ? HarmonicValue{c.re, -c.im} : HarmonicValue{-c.re, c.im};
}

}  // namespace astrolith
