// The part of a triangle that a cube on the ground holds, and sums of heights over the cube's square.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "geometry/surface/ground_axes.h"

namespace astrolith {

// A convex polygon with coordinates along right, ahead and up. A triangle that six planes cut has at most 9
// corners; rounding might make more of a sliver, whose last ones are left out.
struct GroundPolygon {
  std::array<Vec3d, 12> corners;
  std::size_t size = 0;

  void add(const Vec3d& p) {
    if (size < corners.size()) corners[size++] = p;
  }
};

// Keeps what lies where sign * axis <= limit (Sutherland and Hodgman 1974).
inline GroundPolygon cut_by_plane(const GroundPolygon& polygon, double Vec3d::*axis, double sign,
                                  double limit) {
  GroundPolygon kept;
  for (std::size_t i = 0; i < polygon.size; ++i) {
    const Vec3d &a = polygon.corners[i], &b = polygon.corners[(i + 1) % polygon.size];
    const double of_a = limit - sign * (a.*axis), of_b = limit - sign * (b.*axis);
    if (of_a >= 0.0) kept.add(a);
    if ((of_a >= 0.0) != (of_b >= 0.0)) kept.add(a + of_a / (of_a - of_b) * (b - a));
  }
  return kept;
}

// One coordinate of a triangle's corners.
struct CornerCoordinate {
  std::array<double, 3> at;
  double least, most;

  CornerCoordinate(const std::array<Vec3d, 3>& triangle, const Vec3d& axis)
      : at{dot(triangle[0], axis), dot(triangle[1], axis), dot(triangle[2], axis)},
        least(std::min({at[0], at[1], at[2]})),
        most(std::max({at[0], at[1], at[2]})) {}
};

// The part of a triangle in a cube of this side and these axes about the origin. Most triangles near a cube
// lie wholly inside or outside: only planes that have a corner beyond them cut.
inline GroundPolygon cut_to_cube(const std::array<Vec3d, 3>& triangle, const GroundAxes& axes, double side) {
  const double half = 0.5 * side;
  const auto beyond = [half](const CornerCoordinate& c) { return c.least > half || c.most < -half; };
  const CornerCoordinate x(triangle, axes.right);
  if (beyond(x)) return {};
  const CornerCoordinate y(triangle, axes.ahead);
  if (beyond(y)) return {};
  const CornerCoordinate z(triangle, axes.up);
  if (beyond(z)) return {};
  GroundPolygon polygon;
  for (std::size_t k = 0; k < 3; ++k) polygon.add({x.at[k], y.at[k], z.at[k]});
  const auto cut = [&](const CornerCoordinate& c, double Vec3d::*axis) {
    if (c.most > half) polygon = cut_by_plane(polygon, axis, 1.0, half);
    if (c.least < -half) polygon = cut_by_plane(polygon, axis, -1.0, half);
  };
  cut(x, &Vec3d::x), cut(y, &Vec3d::y), cut(z, &Vec3d::z);
  return polygon;
}

// The area times the normal.
inline Vec3d area_vector(const GroundPolygon& polygon) {
  Vec3d sum;
  for (std::size_t i = 2; i < polygon.size; ++i) {
    sum += cross(polygon.corners[i - 1] - polygon.corners[0], polygon.corners[i] - polygon.corners[0]);
  }
  return 0.5 * sum;
}

// Integrals over the square of products of 1, x, y and the height z.
class HeightSums {
 public:
  // Adds a polygon and returns its area seen from above, negative where the ground faces down. The mean of a
  // quadratic over a triangle is its mean over the middles of the edges.
  double add(const GroundPolygon& polygon) {
    double total = 0.0;
    for (std::size_t i = 2; i < polygon.size; ++i) {
      const Vec3d &a = polygon.corners[0], &b = polygon.corners[i - 1], &c = polygon.corners[i];
      const double area = 0.5 * ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
      for (const Vec3d& p : {0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)}) add(p, area / 3.0);
      total += area;
    }
    return total;
  }
  double area() const { return one_; }

  // The root mean square of z about the plane z = u + v x + w y of least squares; 0 without area.
  double rms_about_plane() const {
    if (!(one_ > 0.0)) return 0.0;
    const double x = x_ / one_, y = y_ / one_, z = z_ / one_;
    const double xx = xx_ / one_ - x * x, xy = xy_ / one_ - x * y, yy = yy_ / one_ - y * y;
    const double xz = xz_ / one_ - x * z, yz = yz_ / one_ - y * z, zz = zz_ / one_ - z * z;
    const double determinant = xx * yy - xy * xy;
    if (!(determinant > 0.0)) return 0.0;
    const double v = (xz * yy - yz * xy) / determinant, w = (yz * xx - xz * xy) / determinant;
    return std::sqrt(std::fmax(zz - v * xz - w * yz, 0.0));
  }

 private:
  void add(const Vec3d& p, double weight) {
    one_ += weight;
    x_ += weight * p.x, y_ += weight * p.y, z_ += weight * p.z;
    xx_ += weight * p.x * p.x, xy_ += weight * p.x * p.y, yy_ += weight * p.y * p.y;
    xz_ += weight * p.x * p.z, yz_ += weight * p.y * p.z, zz_ += weight * p.z * p.z;
  }

  double one_ = 0, x_ = 0, y_ = 0, z_ = 0, xx_ = 0, xy_ = 0, yy_ = 0, xz_ = 0, yz_ = 0, zz_ = 0;
};

}  // namespace astrolith
