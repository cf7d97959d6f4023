#include "geometry/surface/ground_axes.h"

#include <cmath>

namespace astrolith {

GroundAxes axes_about(const Vec3d& up) {
  const Vec3d north = std::fabs(up.z) < 0.999 ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0};
  const Vec3d right = normalized(cross(north, up));
  return {right, cross(up, right), up};
}

Vec3d mean_normal(const TriangleMesh& mesh) {
  Vec3d sum;
  for (const auto& [a, b, c] : mesh.triangles)
    sum += cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]);
  return normalized(sum);
}

}  // namespace astrolith
