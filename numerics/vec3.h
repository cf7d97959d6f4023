// Three-component vectors for points, directions and frequencies. The scalar may be float, double or a Ceres
// Jet.
#pragma once

#include <cmath>

#include "numerics/host_device.h"

namespace astrolith {

template <typename T>
struct Vec3 {
  T x{}, y{}, z{};

  ASTROLITH_HD Vec3& operator+=(const Vec3& o) {
    x += o.x;
    y += o.y;
    z += o.z;
    return *this;
  }
  ASTROLITH_HD Vec3& operator-=(const Vec3& o) {
    x -= o.x;
    y -= o.y;
    z -= o.z;
    return *this;
  }
  ASTROLITH_HD Vec3& operator*=(T s) {
    x *= s;
    y *= s;
    z *= s;
    return *this;
  }
  friend ASTROLITH_HD Vec3 operator+(Vec3 a, const Vec3& b) { return a += b; }
  friend ASTROLITH_HD Vec3 operator-(Vec3 a, const Vec3& b) { return a -= b; }
  friend ASTROLITH_HD Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
  friend ASTROLITH_HD Vec3 operator*(Vec3 a, T s) { return a *= s; }
  friend ASTROLITH_HD Vec3 operator*(T s, Vec3 a) { return a *= s; }
  friend ASTROLITH_HD bool operator==(const Vec3& a, const Vec3& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
  }
};

using Vec3d = Vec3<double>;
using Vec3f = Vec3<float>;

template <typename T>
ASTROLITH_HD T dot(const Vec3<T>& a, const Vec3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <typename T>
ASTROLITH_HD Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <typename T>
ASTROLITH_HD T squared_norm(const Vec3<T>& a) {
  return dot(a, a);
}
template <typename T>
ASTROLITH_HD T norm(const Vec3<T>& a) {
  using std::sqrt;
  return sqrt(dot(a, a));
}
// Rounds each coordinate to the nearest float.
inline ASTROLITH_HD Vec3f to_float(const Vec3d& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
// a / |a|; the zero vector gives the zero vector.
template <typename T>
ASTROLITH_HD Vec3<T> normalized(const Vec3<T>& a) {
  const T n = norm(a);
  return n > T(0) ? a * (T(1) / n) : a;
}

// The member of the greatest coordinate, of a vector of T as well: the first of equal ones.
template <typename T = double>
T Vec3<T>::*longest_axis(const Vec3d& extent) {
  const auto& [x, y, z] = extent;
  return x >= y && x >= z ? &Vec3<T>::x : y >= z ? &Vec3<T>::y : &Vec3<T>::z;
}

// The least and the greatest of each coordinate, those of `a` where one of the two is not a number. One
// instruction each, where std::fmin is a call.
ASTROLITH_HD inline Vec3d component_min(const Vec3d& a, const Vec3d& b) {
  return {b.x < a.x ? b.x : a.x, b.y < a.y ? b.y : a.y, b.z < a.z ? b.z : a.z};
}
ASTROLITH_HD inline Vec3d component_max(const Vec3d& a, const Vec3d& b) {
  return {b.x > a.x ? b.x : a.x, b.y > a.y ? b.y : a.y, b.z > a.z ? b.z : a.z};
}

// An axis-aligned box; empty until it has been extended.
struct Box {
  Vec3d min{1e300, 1e300, 1e300};
  Vec3d max{-1e300, -1e300, -1e300};

  void extend(const Vec3d& p) {
    min = component_min(min, p);
    max = component_max(max, p);
  }
  bool empty() const { return !(min.x <= max.x); }
  ASTROLITH_HD Vec3d extent() const { return max - min; }
  ASTROLITH_HD Vec3d center() const { return 0.5 * (min + max); }
  double longest_side() const {
    const Vec3d e = extent();
    return e.*longest_axis(e);
  }
  // The length of the diagonal. Errors are stated as fractions of it.
  double diagonal() const { return norm(extent()); }
};

// The box enlarged by `margin` on every side.
ASTROLITH_HD inline Box widened(const Box& box, double margin) {
  const Vec3d m{margin, margin, margin};
  return {box.min - m, box.max + m};
}

// True when two boxes share a point.
ASTROLITH_HD inline bool boxes_touch(const Box& a, const Box& b) {
  return a.min.x <= b.max.x && a.max.x >= b.min.x && a.min.y <= b.max.y && a.max.y >= b.min.y &&
         a.min.z <= b.max.z && a.max.z >= b.min.z;
}

// The smallest box that holds two boxes, neither of which is empty.
ASTROLITH_HD inline Box united(const Box& a, const Box& b) {
  return {component_min(a.min, b.min), component_max(a.max, b.max)};
}

// The part that two boxes share. Expects that they touch.
inline Box common_part(const Box& a, const Box& b) {
  return {component_max(a.min, b.min), component_min(a.max, b.max)};
}

}  // namespace astrolith
