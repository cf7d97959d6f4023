#include "geometry/surface/ground_plane.h"

#include <cmath>

#include "geometry/mesh_measure.h"

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

std::optional<GroundPlane> mean_plane(const TriangleMesh& mesh) {
  const Vec3d up = mean_normal(mesh);
  if (!(norm(up) > 0.5)) return std::nullopt;
  return GroundPlane{axes_about(up), surface_centroid(mesh)};
}

}  // namespace astrolith
