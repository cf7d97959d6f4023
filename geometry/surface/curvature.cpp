#include "geometry/surface/curvature.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "geometry/surface/half_edge_mesh_internal.h"
#include "numerics/parallel_for.h"
#include "numerics/portable_angles.h"

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

Ring ring_of(const HalfEdges& mesh, OpenMesh::VertexHandle v) {
  Ring ring;
  const Vec3d p = position(mesh, v);
  for (const auto h : mesh.voh_range(v)) {
    ring.add(p, position(mesh, h.to()), position(mesh, h.next().to()));
  }
  return ring;
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
        const Ring ring = ring_of(half_edges, v);
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

}  // namespace astrolith
