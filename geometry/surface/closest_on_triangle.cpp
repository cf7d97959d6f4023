#include "geometry/surface/closest_on_triangle.h"

namespace astrolith {
namespace {

using Feature = TriangleFeature;

ClosestOnTriangle at(const Vec3d& p, const Vec3d& point, Feature feature) {
  return {point, squared_norm(p - point), feature};
}

// The point nearest to p on the segment from start to end. The last three arguments name the segment's two
// ends and its inside.
ClosestOnTriangle closest_on_segment(const Vec3d& p, const Vec3d& start, const Vec3d& end, Feature at_start,
                                     Feature at_end, Feature between) {
  const Vec3d along = end - start;
  const double length2 = squared_norm(along);
  const double t = dot(p - start, along);
  if (!(t > 0)) return at(p, start, at_start);
  if (t >= length2) return at(p, end, at_end);
  return at(p, start + (t / length2) * along, between);
}

ClosestOnTriangle nearer(const ClosestOnTriangle& x, const ClosestOnTriangle& y) {
  return y.squared_distance < x.squared_distance ? y : x;
}

ClosestOnTriangle closest_on_boundary(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const auto ab = closest_on_segment(p, a, b, Feature::corner_a, Feature::corner_b, Feature::side_ab);
  const auto bc = closest_on_segment(p, b, c, Feature::corner_b, Feature::corner_c, Feature::side_bc);
  const auto ca = closest_on_segment(p, c, a, Feature::corner_c, Feature::corner_a, Feature::side_ca);
  return nearer(nearer(ab, bc), ca);
}

}  // namespace

ClosestOnTriangle closest_on_triangle(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d normal = cross(b - a, c - a);
  // Barycentric coordinates of p's projection, not normalised. Each is positive on the inner side of one side
  // of the triangle.
  const double over_a = dot(normal, cross(b - p, c - p));
  const double over_b = dot(normal, cross(c - p, a - p));
  const double over_c = dot(normal, cross(a - p, b - p));
  if (!(over_a > 0 && over_b > 0 && over_c > 0)) return closest_on_boundary(p, a, b, c);
  // The weights sum to one. Differences from a corner therefore keep the digits of triangles far from the
  // origin.
  const double total = over_a + over_b + over_c;
  return at(p, a + (over_b / total) * (b - a) + (over_c / total) * (c - a), Feature::face);
}

}  // namespace astrolith
