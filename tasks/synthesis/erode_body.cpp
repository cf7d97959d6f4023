#include "tasks/synthesis/erode_body.h"

#include <vector>

#include "synthesis/body/body_spheres.h"
#include "synthesis/finish/mascons.h"

namespace astrolith {

ErosionStatistics erode_body(const ImplicitField& field, const Recipe& recipe, TriangleMesh& mesh,
                             const Progress& progress) {
  const Erosion& erosion = *recipe.erosion;
  const std::vector<Mascon> mascons = mascons_of(field, adding_spheres(*recipe.body));
  const std::vector<Vec3d> up =
      vertical_directions(mascons, {erosion.density, erosion.rotation_period}, mesh.vertices);
  return erode(mesh, up, erosion.talus_angle, erosion.iterations, progress);
}

}  // namespace astrolith
