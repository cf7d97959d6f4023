#include "descriptor/spectrum/point_cloud_triangles.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "geometry/points/nearest_neighbours.h"
#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "numerics/tangent_frame.h"

namespace astrolith {
namespace {

struct PlanePoint {
  double x, y;
  std::uint32_t index;
};

// The z component of (b - a) x (c - a): positive for a turn to the left.
double turn(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// The corners of the convex hull, counter-clockwise (Andrew's monotone chain).
std::vector<PlanePoint> convex_hull(std::vector<PlanePoint> points) {
  std::sort(points.begin(), points.end(), [](const PlanePoint& a, const PlanePoint& b) {
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.index < b.index;
  });
  std::vector<PlanePoint> hull;
  const auto extend = [&hull](const PlanePoint& p, std::size_t fixed) {
    while (hull.size() >= fixed + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0) hull.pop_back();
    hull.push_back(p);
  };
  for (const PlanePoint& p : points) extend(p, 0);
  const std::size_t lower = hull.size() - 1;
  for (auto p = points.rbegin() + 1; p != points.rend(); ++p) extend(*p, lower);
  hull.pop_back();
  return hull;
}

// The neighbours of point i in its tangent plane, relative to i and inverted: a place q becomes q / |q|^2.
// Circles through the origin become lines, so that the Delaunay neighbours of the origin are the corners of a
// convex hull.
std::vector<PlanePoint> inverted_neighbours(std::span<const Vec3d> points, std::uint32_t i,
                                            const Vec3d& normal, std::span<const std::uint32_t> around) {
  const auto [u, v] = crossed_tangents(normal);
  std::vector<PlanePoint> inverted;
  for (const std::uint32_t j : around) {
    const Vec3d d = points[j] - points[i];
    const double x = dot(d, u), y = dot(d, v), squared = x * x + y * y;
    if (squared > 1e-12 * squared_norm(d)) inverted.push_back({x / squared, y / squared, j});
  }
  return inverted;
}

std::vector<Triangle> star(std::span<const Vec3d> points, std::uint32_t i, const Vec3d& normal,
                           std::span<const std::uint32_t> around) {
  std::vector<PlanePoint> inverted = inverted_neighbours(points, i, normal, around);
  if (inverted.size() < 2) return {};
  const std::vector<PlanePoint> hull = convex_hull(std::move(inverted));
  std::vector<Triangle> triangles;
  for (std::size_t k = 0; k < hull.size(); ++k) {
    const PlanePoint &a = hull[k], &b = hull[(k + 1) % hull.size()];
    // A side that does not run counter-clockwise around the origin is a gap, because i lies on a border.
    if (a.x * b.y - a.y * b.x > 0) triangles.push_back({i, a.index, b.index});
  }
  return triangles;
}

}  // namespace

std::vector<Triangle> point_cloud_triangles(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                                            int neighbours) {
  if (points.size() != normals.size() || neighbours < 3) {
    throw InputError("point cloud: " + std::to_string(points.size()) + " points have " +
                     std::to_string(normals.size()) + " normals and " + std::to_string(neighbours) +
                     " neighbours; give a normal for each and at least 3 neighbours");
  }
  const std::vector<std::uint32_t> nearest = nearest_neighbours(points, neighbours);
  const auto k = static_cast<std::size_t>(neighbours);
  std::vector<std::vector<Triangle>> stars(points.size());
  parallel_for(
      0, static_cast<std::int64_t>(points.size()),
      [&](std::int64_t index) {
        const auto i = static_cast<std::uint32_t>(index);
        stars[i] = star(points, i, normals[i], std::span(nearest).subspan(i * k, k));
      },
      64);
  std::vector<Triangle> triangles;
  for (const auto& s : stars) triangles.insert(triangles.end(), s.begin(), s.end());
  return triangles;
}

}  // namespace astrolith
