// The containment points of a base fit: points inside and outside of the target, beside its surface samples.
#pragma once

#include <cstdint>

#include "estimation/shape/target/target_body.h"

namespace astrolith {

struct ContainmentOptions {
  double deepest = 0.5;      // radius of the largest sphere inside the target, fraction of the diagonal, > 0
  std::int64_t samples = 0;  // surface samples of the fit, which scale the number of points, >= 0
  std::uint64_t seed = 1;    // of points anywhere in the box
  std::uint64_t shell_seed = 2;  // of points beside the surface
};

// Points at least 0.015 of the diagonal from the surface, shells of points beside it at 0.008, 0.016 and
// 0.032, and points in the middle of parts that are thinner than the first shell is deep. A body that is thin
// everywhere has its deep points at half of its greatest depth.
FitPoints containment_points(const TargetBody& target, const ContainmentOptions& options);

}  // namespace astrolith
