#include "geometry/mesh_normals.h"

#include <cmath>

#include "numerics/portable_angles.h"

namespace astrolith {
namespace {

// The angle between two vectors in [0, pi]. It is accurate near 0 and pi, unlike the arc cosine.
double angle_between(const Vec3d& a, const Vec3d& b) { return portable::atan2(norm(cross(a, b)), dot(a, b)); }

}  // namespace

Vec3d triangle_normal(const TriangleMesh& mesh, const Triangle& t) {
  const Vec3d& a = mesh.vertices[t[0]];
  return normalized(cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a));
}

std::vector<Vec3d> triangle_normals(const TriangleMesh& mesh) {
  std::vector<Vec3d> normals;
  normals.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) normals.push_back(triangle_normal(mesh, t));
  return normals;
}

std::vector<Vec3d> vertex_normals(const TriangleMesh& mesh) {
  std::vector<Vec3d> sums(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles) {
    const Vec3d n = triangle_normal(mesh, t);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d& p = mesh.vertices[t[k]];
      sums[t[k]] += angle_between(mesh.vertices[t[(k + 1) % 3]] - p, mesh.vertices[t[(k + 2) % 3]] - p) * n;
    }
  }
  for (Vec3d& n : sums) n = normalized(n);
  return sums;
}

}  // namespace astrolith
