#include "geometry/atlas/vertex_tangents.h"

#include <cmath>
#include <cstddef>

#include "numerics/portable_angles.h"
#include "numerics/tangent_frame.h"

namespace astrolith {
namespace {

// The derivative of position by u over a triangle, times a positive number, and twice the area of its image,
// negative for a mirrored one.
struct TextureSlope {
  Vec3d along_u;
  double area;
};

TextureSlope texture_slope(const std::array<Vec3d, 3>& p, const std::array<TexturePoint, 3>& t) {
  const double u1 = double{t[1][0]} - t[0][0], u2 = double{t[2][0]} - t[0][0];
  // Upwards in the image, which is -v.
  const double v1 = double{t[0][1]} - t[1][1], v2 = double{t[0][1]} - t[2][1];
  const double area = u1 * v2 - u2 * v1;
  const double sign = area < 0.0 ? -1.0 : 1.0;
  return {sign * (v2 * (p[1] - p[0]) - v1 * (p[2] - p[0])), area};
}

Vec3d along_plane(const Vec3d& v, const Vec3d& normal) { return v - dot(v, normal) * normal; }

double corner_angle(const Vec3d& a, const Vec3d& b) { return portable::atan2(norm(cross(a, b)), dot(a, b)); }

}  // namespace

std::vector<VertexTangent> vertex_tangents(const TriangleMesh& mesh, const TextureCoordinates& coordinates) {
  std::vector<Vec3d> sums(coordinates.uv.size());
  std::vector<double> areas(coordinates.uv.size());  // slivers, whose sign is that of rounding, count little
  for (const Triangle& t : coordinates.triangles) {
    std::array<Vec3d, 3> p;
    std::array<TexturePoint, 3> uv;
    for (std::size_t k = 0; k < 3; ++k)
      p[k] = mesh.vertices[coordinates.vertex_of[t[k]]], uv[k] = coordinates.uv[t[k]];
    const TextureSlope slope = texture_slope(p, uv);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d& normal = mesh.normals[coordinates.vertex_of[t[k]]];
      const Vec3d next = along_plane(p[(k + 1) % 3] - p[k], normal),
                  last = along_plane(p[(k + 2) % 3] - p[k], normal);
      sums[t[k]] += corner_angle(next, last) * normalized(along_plane(slope.along_u, normal));
      areas[t[k]] += slope.area;
    }
  }
  std::vector<VertexTangent> tangents(sums.size());
  for (std::size_t w = 0; w < sums.size(); ++w) {
    const Vec3d& normal = mesh.normals[coordinates.vertex_of[w]];
    Vec3d tangent = normalized(along_plane(sums[w], normal));
    if (!(squared_norm(tangent) > 0.0)) tangent = crossed_tangents(normal).first;
    const Vec3f t = to_float(tangent);
    tangents[w] = {t.x, t.y, t.z, areas[w] < 0.0 ? -1.0f : 1.0f};
  }
  return tangents;
}

}  // namespace astrolith
