// The histogram bin of one pair of oriented points: one float function for CPU and GPU, without branches.
//
// Wahl, Hillenbrand and Hirzinger, "Surflet-pair-relation histograms", 3DIM 2003. Of two surflets the origin
// (p1, n1) is the one with |n1.(p2 - p1)| <= |n2.(p2 - p1)|. Its normal makes the larger angle with the
// connecting line, which keeps the frame well defined (thesis eq. 3.1; the Point Cloud Library chooses the
// other surflet). Where both are equal, the origin is the one with n1.(p2 - p1) >= 0, so that the order of
// the two never matters. With d = (p2 - p1) / |p2 - p1| the frame is u = n1, v = d x u / |d x u|, w = u x v,
// and
//   alpha = atan2(w.n2, u.n2) in (-pi, pi]     beta  = v.n2 in [-1, 1]
//   gamma = u.d in [-1, 1]                     delta = |p2 - p1| / largest distance in (0, 1]
// are cut into equal bins. These ranges follow from Wahl's formulas. The thesis (3.3.1) prints other ranges,
// and -d in gamma, which mirrors that axis.
//
// The code takes no root, quotient or arc tangent. A feature is beyond a border when its square is beyond the
// square of the border. Squares and signs also tell on which side of the direction of a border an angle lies.
//
// The CPU and the GPU count oriented points in one order, since the first of two points decides how a pair on
// the border of a bin is rounded.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "numerics/host_device.h"
#include "numerics/scalar_math.h"
#include "numerics/vec3.h"

namespace astrolith {

struct Surflet {
  Vec3f point;   // in units of the largest distance between two points, the middle of their box at 0
  Vec3f normal;  // unit length
  Vec3f moment;  // normal x point: with the normal the Pluecker coordinates of the line along the normal
};

ASTROLITH_KERNEL Surflet surflet(Vec3f point, Vec3f normal) { return {point, normal, cross(normal, point)}; }

// Squares of the borders between kBins equal bins, on one side of the middle. An even number of bins has one
// more border, at the middle itself.
template <int kBins>
struct PairBorders {
  static constexpr int kSide = (kBins - 1) / 2;
  static constexpr bool kEven = kBins % 2 == 0;
  std::array<float, kSide> unit{};        // borders of [-1, 1]
  std::array<float, kSide> tangent{};     // tan^2 of the borders of (-pi, pi]
  std::array<bool, kSide> obtuse{};       // whether this border is beyond pi / 2 ...
  std::array<bool, kSide> right{};        // ... or at pi / 2
  std::array<float, kBins - 1> length{};  // borders of [0, 1]

  constexpr PairBorders() {
    for (int k = 0; k < kSide; ++k) {
      const int twice = kEven ? 2 * (k + 1) : 2 * k + 1;  // the border is twice / kBins of the half axis
      const double fraction = static_cast<double>(twice) / kBins, c = cosine(fraction), c2 = c * c;
      unit[at(k)] = static_cast<float>(fraction * fraction);
      right[at(k)] = 2 * twice == kBins;
      obtuse[at(k)] = 2 * twice > kBins;
      tangent[at(k)] = right[at(k)] ? 0.0f : static_cast<float>((1 - c2) / c2);
    }
    for (int k = 1; k < kBins; ++k) {
      length[at(k - 1)] = static_cast<float>(static_cast<double>(k * k) / (kBins * kBins));
    }
  }

 private:
  static constexpr std::size_t at(int k) { return static_cast<std::size_t>(k); }
  // cos(pi x) for x in [0, 1] by its Taylor series; std::cos is no constant expression.
  static constexpr double cosine(double x) {
    const double t2 = 3.14159265358979323846 * 3.14159265358979323846 * x * x;
    double term = 1, sum = 1;
    for (int k = 1; k <= 15; ++k) sum += term *= -t2 / ((2 * k - 1) * (2 * k));
    return sum;
  }
};

// The numbers that the four features are made of; r = p2 - p1.
struct SurfletPair {
  bool origin_is_j;  // the second of the two surflets given is p1
  float length2;     // |r|^2
  float u_r;         // u.r
  float across2;     // |r x u|^2, at least 1e-12, so that alpha is defined for a line along both normals
  float cosine;      // u.n2
  float v_n2;        // v.n2 |r x u|
  float w_n2;        // w.n2 |r x u|
};

ASTROLITH_KERNEL SurfletPair surflet_pair(const Surflet& i, const Surflet& j) {
  using math::fma;
  const Vec3f n = i.normal, m = j.normal, a = i.moment, b = j.moment;
  const float rx = j.point.x - i.point.x, ry = j.point.y - i.point.y, rz = j.point.z - i.point.z;
  const float along_i = fma(n.x, rx, fma(n.y, ry, n.z * rz));
  const float along_j = fma(m.x, -rx, fma(m.y, -ry, m.z * -rz));  // as seen from j
  SurfletPair pair;
  pair.length2 = fma(rx, rx, fma(ry, ry, rz * rz));
  pair.cosine = fma(n.x, m.x, fma(n.y, m.y, n.z * m.z));
  // (r x u).n2 = r.(n x m), whichever surflet is the origin. It is the reciprocal product of the lines along
  // the two normals.
  pair.v_n2 = fma(n.x, b.x, fma(n.y, b.y, fma(n.z, b.z, fma(m.x, a.x, fma(m.y, a.y, m.z * a.z)))));
  // A relative 2e-7 in favour of a positive along_i decides for parallel normals, whose values may differ by
  // rounding.
  pair.origin_is_j = math::abs(along_j) < fma(-2e-7f, along_i, math::abs(along_i));
  pair.u_r = pair.origin_is_j ? along_j : along_i;
  const float minus_n2_r = pair.origin_is_j ? along_i : along_j;
  pair.across2 = math::max(fma(-pair.u_r, pair.u_r, pair.length2), 1e-12f);
  pair.w_n2 = fma(-pair.u_r, pair.cosine, -minus_n2_r);
  return pair;
}

// Adds `amount` when the condition holds, in a form that compilers turn into masked additions.
ASTROLITH_KERNEL void add_if(bool condition, float amount, float& sum) {
  sum = condition ? sum + amount : sum;
}

// `stride` with the sign of `value`.
ASTROLITH_KERNEL float signed_as(float value, float stride) {
  return math::from_bits((math::to_bits(value) & INT32_MIN) | math::to_bits(stride));
}

// Adds stride times the bin of value / scale among the bins of [-1, 1], counted from the middle one, from the
// squares of both. A value on a border belongs to the bin nearer to zero, and 0/0 to the middle bin.
template <int kBins>
ASTROLITH_KERNEL void add_unit_bin(float value, float scale2, float stride, float& sum) {
  constexpr PairBorders<kBins> borders;
  const float value2 = value * value;
  const float step = signed_as(value, stride);
  if (borders.kEven) add_if(value < 0.0f, -stride, sum);
  ASTROLITH_UNROLL
  for (int k = 0; k < borders.kSide; ++k) {
    add_if(value2 > borders.unit[static_cast<std::size_t>(k)] * scale2, step, sum);
  }
}

// Adds stride times the bin of the angle atan2(y, x) among the bins of (-pi, pi], counted from the middle
// one, from y and x |x|.
template <int kBins>
ASTROLITH_KERNEL void add_angle_bin(float y, float signed_x2, float stride, float& sum) {
  constexpr PairBorders<kBins> borders;
  const float y2 = y * y;
  const float step = signed_as(y, stride);
  if (borders.kEven) add_if(y < 0.0f, -stride, sum);
  ASTROLITH_UNROLL
  for (int k = 0; k < borders.kSide; ++k) {
    const auto at = static_cast<std::size_t>(k);
    const float t = borders.tangent[at];
    const bool beyond = borders.right[at]    ? signed_x2 < 0.0f
                        : borders.obtuse[at] ? math::fma(t, signed_x2, y2) < 0.0f
                                             : y2 > t * signed_x2;
    add_if(beyond, step, sum);
  }
}

// The code ((alpha kBins + beta) kBins + gamma) kBins + delta with bins 0 .. kBins - 1, plus kBins^4 where j
// is the origin. The bins are the same for (i, j) and (j, i), but for rounding. The code is always defined:
// for points in the same place beta and gamma are in the middle bin and delta is 0. There, and where both
// normals lie along the connecting line, alpha is 0 or pi as the normals agree or oppose.
template <int kBins>
ASTROLITH_KERNEL std::int32_t surflet_code(const Surflet& i, const Surflet& j) {
  constexpr PairBorders<kBins> borders;
  constexpr float kGamma = kBins, kBeta = kGamma * kBins, kAlpha = kBeta * kBins;
  const SurfletPair pair = surflet_pair(i, j);
  // Floats hold whole numbers below 2^24 exactly, and the sign of a float costs nothing.
  constexpr int kMiddleBin = kBins / 2;
  float code = kMiddleBin * (kAlpha + kBeta + kGamma);
  ASTROLITH_UNROLL
  for (int k = 0; k + 1 < kBins; ++k) {
    add_if(pair.length2 > borders.length[static_cast<std::size_t>(k)], 1.0f, code);
  }
  add_angle_bin<kBins>(pair.w_n2, pair.cosine * math::abs(pair.cosine) * pair.across2, kAlpha, code);
  add_unit_bin<kBins>(pair.v_n2, pair.across2, kBeta, code);
  add_unit_bin<kBins>(pair.u_r, pair.length2, kGamma, code);
  add_if(pair.origin_is_j, kAlpha * kBins, code);
  return static_cast<std::int32_t>(code);
}

// Pointers to the coordinates of consecutive surflets: point, normal, moment.
struct SurfletRun {
  std::array<const float*, 9> c;
};

// The number of elements that may be read behind the last surflet of a run.
inline constexpr std::size_t kSurfletPadding = 64;

// One array for each coordinate, for vector loads, with room behind the last point. Points of one local code
// stand together. Among them a hash of the position decides the order. The order in which points are given
// therefore changes nothing, and neighbours in space do not follow one another; their pairs with a third
// point often share a bin.
struct SurfletArrays {
  std::array<std::vector<float>, 9> c;   // (n + kSurfletPadding) each
  std::vector<std::int64_t> code_first;  // (num_local + 1)

  // Points must be in units of their largest distance, normals must have unit length, and local codes must be
  // in [0, num_local).
  SurfletArrays(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                std::span<const std::int32_t> local, int num_local);

  std::int64_t size() const { return code_first.back(); }
  Surflet at(std::int64_t i) const {
    const auto k = static_cast<std::size_t>(i);
    return {{c[0][k], c[1][k], c[2][k]}, {c[3][k], c[4][k], c[5][k]}, {c[6][k], c[7][k], c[8][k]}};
  }
  SurfletRun from(std::int64_t i) const {
    SurfletRun run{};
    for (std::size_t d = 0; d < c.size(); ++d) run.c[d] = c[d].data() + i;
    return run;
  }

 private:
  void set(std::size_t k, const Surflet& s);
};

}  // namespace astrolith
