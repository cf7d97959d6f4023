#include "geometry/surface/sample_curvature.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "geometry/mesh_measure.h"
#include "geometry/points/point_tree_internal.h"
#include "geometry/surface/half_edge_mesh_internal.h"
#include "numerics/parallel_for.h"
#include "numerics/portable_angles.h"
#include "numerics/reported_loop.h"
#include "numerics/tangent_frame.h"

namespace astrolith {
namespace {

Vec3d position(const HalfEdges& mesh, OpenMesh::VertexHandle v) {
  const OpenMesh::Vec3d& p = mesh.point(v);
  return {p[0], p[1], p[2]};
}

double angle(const Vec3d& a, const Vec3d& b) { return portable::atan2(norm(cross(a, b)), dot(a, b)); }
double cotangent(const Vec3d& a, const Vec3d& b) { return dot(a, b) / norm(cross(a, b)); }

// Sums over the triangles (p, q, r) around a vertex p.
struct Ring {
  double angles = 0;
  double area = 0;
  Vec3d laplacian;  // sum of cotangent * (p - neighbour)
  Vec3d normal;     // sum of area * normal

  void add(const Vec3d& p, const Vec3d& q, const Vec3d& r) {
    const Vec3d pq = q - p, pr = r - p, qr = r - q;
    const Vec3d doubled = cross(pq, pr);
    const double cot_q = cotangent(-pq, qr), cot_r = cotangent(-pr, -qr);
    angles += angle(pq, pr);
    laplacian += cot_r * -pq + cot_q * -pr;
    normal += doubled;
    // The mixed area: the Voronoi region where it lies inside the triangle, otherwise half of an obtuse
    // triangle at its obtuse corner and a quarter at its other corners.
    if (dot(pq, pr) < 0) {
      area += norm(doubled) / 4;
    } else if (cot_q < 0 || cot_r < 0) {
      area += norm(doubled) / 8;
    } else {
      area += (squared_norm(pr) * cot_q + squared_norm(pq) * cot_r) / 8;
    }
  }
};

Ring find_ring(const HalfEdges& mesh, OpenMesh::VertexHandle v) {
  Ring ring;
  const Vec3d p = position(mesh, v);
  for (const auto h : mesh.voh_range(v)) {
    ring.add(p, position(mesh, h.to()), position(mesh, h.next().to()));
  }
  return ring;
}

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

VertexCurvature vertex_curvature(const TriangleMesh& mesh) {
  const HalfEdgeMesh cut = half_edge_mesh(mesh);
  const HalfEdges& half_edges = cut.half_edges;
  const std::size_t n = mesh.vertices.size();
  VertexCurvature result{
      std::vector<double>(n, 0.0), std::vector<double>(n, 0.0), std::vector<double>(n, 0.0), {}};
  parallel_for(
      0, static_cast<std::int64_t>(cut.original.size()),
      [&](std::int64_t i) {
        const OpenMesh::VertexHandle v(static_cast<int>(i));
        const std::size_t o = cut.original[static_cast<std::size_t>(i)];
        if (cut.copies[o] != 1 || half_edges.is_boundary(v)) return;
        const Ring ring = find_ring(half_edges, v);
        const double size = norm(ring.laplacian) / (4 * ring.area);
        if (!(ring.area > 0) || !std::isfinite(size)) return;
        result.area[o] = ring.area;
        result.gaussian[o] = (2 * std::numbers::pi - ring.angles) / ring.area;
        result.mean[o] = dot(ring.laplacian, ring.normal) < 0 ? -size : size;
      },
      256);
  for (std::uint32_t v = 0; v < n; ++v) {
    if (result.area[v] == 0) result.left_out.push_back(v);
  }
  return result;
}

SampleCurvature sample_curvature(const TriangleMesh& mesh, const SurfaceSamples& samples, double radius,
                                 const Progress& progress) {
  const VertexCurvature at_vertices = vertex_curvature(mesh);
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
      const double weight = closeness * closeness * at_vertices.area[v];
      integral += weight * at_vertices.gaussian[v];
      area += weight;
    }
    return area > 0 ? integral / area : kUndefined;
  });
  result.vertices_left_out = static_cast<std::int64_t>(at_vertices.left_out.size());
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
