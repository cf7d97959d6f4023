// The points of the target that the refinement uses as conditions.
#pragma once

#include <vector>

#include "numerics/vec3.h"

namespace astrolith {

// Points in the target's frame, whose unit is the diagonal of the bounding box.
struct FitPoints {
  std::vector<Vec3d> on_surface;  // the model's surface must pass through them
  std::vector<Vec3d> inside;      // they must lie inside the model
  std::vector<Vec3d> outside;     // they must lie outside the model
};

}  // namespace astrolith
