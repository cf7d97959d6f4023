#include "geometry/surface/sample_curvature.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/mesh_normals.h"
#include "geometry/points/point_tree_internal.h"
#include "geometry/surface/curvature.h"
#include "numerics/reported_loop.h"
#include "numerics/tangent_frame.h"

namespace astrolith {
namespace {

constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();

// The curvatures curvature_at(i), i = 0 .. n - 1. Values that are not finite count as undefined and become 0.
template <typename CurvatureAt>
SampleCurvature at_all(std::size_t n, const Progress& progress, const CurvatureAt& curvature_at) {
  SampleCurvature result;
  result.gaussian.assign(n, 0.0);
  const auto count = static_cast<std::int64_t>(n);
  reported_parallel_for({0, count, count}, progress, "curvature", [&](std::int64_t i) {
    result.gaussian[static_cast<std::size_t>(i)] = curvature_at(static_cast<std::size_t>(i));
  });
  for (double& k : result.gaussian) {
    if (std::isfinite(k)) continue;
    k = 0;
    ++result.undefined;
  }
  return result;
}

double farthest_corner(const TriangleMesh& mesh, const Triangle& triangle, const Vec3d& place) {
  double farthest = 0;
  for (const std::uint32_t v : triangle) farthest = std::max(farthest, norm(mesh.vertices[v] - place));
  return farthest;
}

// K at (0, 0) of the quadric fitted to heights z over the tangent plane (x, y). All lengths are divided by
// the largest before the fit, so that the rank does not depend on the unit.
double quadric_curvature(const std::vector<Vec3d>& heights) {
  double size = 0;
  for (const Vec3d& h : heights) size = std::max(size, norm(h));
  if (heights.size() < 6 || !(size > 0)) return kUndefined;
  Eigen::Matrix<double, Eigen::Dynamic, 6> terms(heights.size(), 6);
  Eigen::VectorXd z(heights.size());
  for (std::size_t k = 0; k < heights.size(); ++k) {
    const Vec3d h = (1 / size) * heights[k];
    const auto row = static_cast<Eigen::Index>(k);
    terms.row(row) << 0.5 * h.x * h.x, h.x * h.y, 0.5 * h.y * h.y, h.x, h.y, 1;
    z[row] = h.z;
  }
  Eigen::ColPivHouseholderQR<Eigen::Matrix<double, Eigen::Dynamic, 6>> qr(terms);
  qr.setThreshold(1e-9);
  if (qr.rank() < 6) return kUndefined;
  const Eigen::Matrix<double, 6, 1> q = qr.solve(z);
  const double slope = 1 + q[3] * q[3] + q[4] * q[4];
  return (q[0] * q[2] - q[1] * q[1]) / (slope * slope) / (size * size);
}

}  // namespace

SampleCurvature sample_curvature(const TriangleMesh& mesh, const SurfaceSamples& samples, double radius,
                                 const Progress& progress) {
  const VertexCurvature of_vertices = vertex_curvature(mesh);
  const std::vector<Vec3d> normals = vertex_normals(mesh);
  const PointTree tree(mesh.vertices);
  SampleCurvature result = at_all(samples.points.size(), progress, [&](std::size_t i) {
    const Vec3d& place = samples.points[i];
    const double corner = farthest_corner(mesh, mesh.triangles[samples.triangles[i]], place);
    double integral = 0, area = 0;
    const double reach = std::max(radius, corner);
    for (const auto& [v, squared] : tree.within(place, reach)) {
      if (dot(normals[v], samples.normals[i]) <= 0) continue;
      const double closeness = 1 - squared / (reach * reach);
      const double weight = closeness * closeness * of_vertices.area[v];
      integral += weight * of_vertices.gaussian[v];
      area += weight;
    }
    return area > 0 ? integral / area : kUndefined;
  });
  result.vertices_left_out = static_cast<std::int64_t>(of_vertices.left_out.size());
  return result;
}

SampleCurvature point_curvature(std::span<const Vec3d> points, std::span<const Vec3d> normals, int neighbours,
                                const Progress& progress) {
  const PointTree tree(points);
  return at_all(points.size(), progress, [&](std::size_t i) {
    const auto [x, y] = crossed_tangents(normals[i]);
    std::vector<Vec3d> heights;
    for (const std::uint32_t j : tree.nearest(points[i], static_cast<std::size_t>(neighbours))) {
      const Vec3d r = points[j] - points[i];
      if (dot(normals[j], normals[i]) > 0) heights.push_back({dot(x, r), dot(y, r), dot(normals[i], r)});
    }
    return quadric_curvature(heights);
  });
}

}  // namespace astrolith
