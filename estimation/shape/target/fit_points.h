// Points of the target that the refinement of a fit is held to.
#pragma once

#include <vector>

#include "numerics/vec3.h"

namespace astrolith {

// Points in the target's frame, whose unit is the diagonal of the bounding box.
struct FitPoints {
  std::vector<Vec3d> on_surface;
  std::vector<Vec3d> inside;   // where the body must be
  std::vector<Vec3d> outside;  // where it must not be
};

}  // namespace astrolith
