// The histogram bin of one pair of oriented points: one float function for CPU and GPU, without branches.
//
// Wahl, Hillenbrand and Hirzinger, "Surflet-pair-relation histograms", 3DIM 2003. Of two surflets the origin
// (p1, n1) is the one with |n1.(p2 - p1)| <= |n2.(p2 - p1)|: the normal that makes the larger angle with the
// connecting line, which keeps the frame well defined (thesis eq. 3.1; the Point Cloud Library chooses the
// other one). Should both be equal, the one with n1.(p2 - p1) >= 0, so that the order of the two never
// matters. With d = (p2 - p1) / |p2 - p1| the frame is u = n1, v = d x u / |d x u|, w = u x v, and
//   alpha = atan2(w.n2, u.n2) in (-pi, pi]     beta  = v.n2 in [-1, 1]
//   gamma = u.d in [-1, 1]                     delta = |p2 - p1| / largest distance in (0, 1]
// are cut into five equal bins each. The ranges are those that Wahl's formulas have; the thesis (3.3.1)
// prints others, and -d in gamma, which mirrors that axis.
#pragma once

#include <cstdint>

#include "numerics/host_device.h"
#include "numerics/scalar_math.h"
#include "numerics/vec3.h"

namespace astrolith {

inline constexpr int kSurfletBins = 625;

struct Surflet {
  Vec3f point;   // in units of the largest distance between two points
  Vec3f normal;  // unit length
};

// Index in -2 .. 2 of value/scale among the bins of [-1, 1] with borders at +-0.2 and +-0.6, from squares;
// a value on a border belongs to the bin nearer to zero. scale >= 0; 0/0 is in the middle.
ASTROLITH_HD inline std::int32_t symmetric_bin(float value, float squared_scale) {
  const float squared = value * value;
  const std::int32_t beyond =
      (squared > 0.04f * squared_scale ? 1 : 0) + (squared > 0.36f * squared_scale ? 1 : 0);
  return value < 0.0f ? -beyond : beyond;
}

// Index in -2 .. 2 of atan2(y, x) among the bins of (-pi, pi] with borders at +-pi/5 and +-3pi/5: the side on
// which (x, |y|) lies of each border's direction. No arc tangent is needed for that.
ASTROLITH_HD inline std::int32_t angle_bin(float y, float x) {
  constexpr float kCos36 = 0.80901699437494742f, kSin36 = 0.58778525229247313f;
  constexpr float kCos108 = -0.30901699437494742f, kSin108 = 0.95105651629515357f;
  const float height = math::abs(y);
  const std::int32_t beyond =
      (kCos36 * height > kSin36 * x ? 1 : 0) + (kCos108 * height > kSin108 * x ? 1 : 0);
  return y < 0.0f ? -beyond : beyond;
}

// ((alpha 5 + beta) 5 + gamma) 5 + delta with bins 0 .. 4, the same for (i, j) and (j, i). Always defined:
// points in the same place have alpha, beta and gamma in the middle and delta at 0; where both normals lie
// along the connecting line beta is in the middle and alpha 0 or pi as the normals agree or oppose.
ASTROLITH_HD inline std::int32_t surflet_bin(Surflet i, Surflet j) {
  using math::fma;
  const Vec3f n = i.normal, m = j.normal;
  const float rx = j.point.x - i.point.x, ry = j.point.y - i.point.y, rz = j.point.z - i.point.z;
  const float length2 = fma(rx, rx, fma(ry, ry, rz * rz));
  const float along_i = fma(n.x, rx, fma(n.y, ry, n.z * rz));
  const float along_j = fma(m.x, rx, fma(m.y, ry, m.z * rz));
  const float cosine = fma(n.x, m.x, fma(n.y, m.y, n.z * m.z));
  // (r x u).n2 = r.(n x m), whichever of the two is the origin. Without fma it is exactly antisymmetric.
  const float triple =
      fma(rx, n.y * m.z - n.z * m.y, fma(ry, n.z * m.x - n.x * m.z, rz * (n.x * m.y - n.y * m.x)));

  // Were j the origin, r would change its sign.
  const float size_i = math::abs(along_i), size_j = math::abs(along_j);
  const bool origin_is_j = (size_j < size_i) | ((size_j == size_i) & (along_i < 0.0f));
  const float u_r = origin_is_j ? -along_j : along_i;  // u.(p2 - p1)
  const float m_r = origin_is_j ? -along_i : along_j;  // n2.(p2 - p1)

  // |r x u|^2, kept above rounding noise so that a line along both normals has a defined alpha.
  const float across2 = math::max(fma(-u_r, u_r, length2), 1e-12f * length2);
  const float across = math::sqrt(across2);
  // w.n2 and u.n2, both times |r x u|.
  const std::int32_t alpha = angle_bin(fma(-u_r, cosine, m_r), cosine * across);
  const std::int32_t beta = symmetric_bin(triple, across2);
  const std::int32_t gamma = symmetric_bin(u_r, length2);
  const std::int32_t delta = (length2 > 0.04f ? 1 : 0) + (length2 > 0.16f ? 1 : 0) +
                             (length2 > 0.36f ? 1 : 0) + (length2 > 0.64f ? 1 : 0);
  constexpr std::int32_t kMiddle = 2 * 125 + 2 * 25 + 2 * 5;
  return kMiddle + 125 * alpha + 25 * beta + 5 * gamma + delta;
}

}  // namespace astrolith
