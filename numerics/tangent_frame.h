// Two unit vectors at right angles to a unit vector n and to each other: a frame of the plane across n.
// Which of the many frames comes out decides bytes of meshes and pictures, so each caller keeps its choice:
//   duff_tangents    needs no square root and no branch on the longest axis, and suits loops over points;
//   crossed_tangents crosses n with a coordinate axis, and serves descriptors and fits in double precision.
#pragma once

#include <cmath>

#include "numerics/host_device.h"
#include "numerics/scalar_math.h"
#include "numerics/vec3.h"

namespace astrolith {

template <typename T>
struct Tangents {
  Vec3<T> first, second;
};

// The rounding of a b + c: once, as explicit fma, or twice, after the product and after the sum.
enum class SumRounding { kFused, kTwice };
template <SumRounding kRounding>
ASTROLITH_KERNEL float multiply_add(float a, float b, float c) {
  return kRounding == SumRounding::kFused ? math::fma(a, b, c) : a * b + c;
}

// Duff et al., "Building an orthonormal basis, revisited", Journal of Computer Graphics Techniques 2017:
//   s = -1 / (sign + n.z),   first  = (1 + sign n.x^2 s, sign n.x n.y s, -sign n.x),
//                            second = (n.x n.y s, sign + n.y^2 s, -n.y).
// n has unit length. `sign` is 1 where n.z > 0 and -1 where n.z < 0; at n.z = 0 either will do. first, second
// and n form a right-handed frame.
template <SumRounding kRounding>
ASTROLITH_KERNEL Tangents<float> duff_tangents(const Vec3f& n, float sign) {
  const float s = -1.0f / (sign + n.z), t = n.x * n.y * s;
  return {{multiply_add<kRounding>(sign * n.x * n.x, s, 1.0f), sign * t, -sign * n.x},
          {t, multiply_add<kRounding>(n.y * n.y, s, sign), -n.y}};
}

// first = n x e / |n x e| and second = n x first, where e is the x axis or, where n leans towards it
// (|n.x| >= 0.6), the y axis. n has unit length. first, second and n form a right-handed frame.
inline Tangents<double> crossed_tangents(const Vec3d& n) {
  const Vec3d axis = std::fabs(n.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  const Vec3d first = normalized(cross(n, axis));
  return {first, cross(n, first)};
}

}  // namespace astrolith
