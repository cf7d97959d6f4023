#include "geometry/surface/ground_plane.h"

#include "geometry/mesh_measure.h"

namespace astrolith {

std::optional<GroundPlane> mean_plane(const TriangleMesh& mesh) {
  const Vec3d up = mean_normal(mesh);
  if (!(norm(up) > 0.5)) return std::nullopt;
  return GroundPlane{axes_about(up), surface_centroid(mesh)};
}

}  // namespace astrolith
