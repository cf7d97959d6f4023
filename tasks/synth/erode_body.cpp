#include "tasks/synth/erode_body.h"

#include "gravity/vertical_directions.h"

namespace astrolith {

ErosionStatistics erode_body(const Erosion& erosion, TriangleMesh& mesh, const Progress& progress) {
  const std::vector<Vec3d> up = vertical_directions(mesh, {erosion.density, erosion.rotation_period});
  return erode(mesh, up, erosion.talus_angle, erosion.iterations, progress);
}

}  // namespace astrolith
