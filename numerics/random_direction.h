// Random directions about an axis, for the waves and kernels of noises.
#pragma once

#include "numerics/host_device.h"
#include "numerics/scalar_math.h"
#include "numerics/tangent_frame.h"
#include "numerics/vec3.h"

namespace astrolith {

// A random unit vector, uniform over the directions whose cosine with the unit vector `axis` is at least 1 -
// spread. spread is in [0, 1]: 0 gives the axis itself, 1 the hemisphere about it. A wave of either sign of
// its direction is one wave, so that a hemisphere holds all directions of a wave. a and b are uniform in [0,
// 1).
ASTROLITH_KERNEL Vec3f direction_in_cone(const Vec3f& axis, float spread, float a, float b) {
  const float along = 1.0f - spread * a;
  const float across = math::sqrt(math::max(0.0f, math::fma(-along, along, 1.0f)));
  const auto [u, v] = duff_tangents<SumRounding::kFused>(axis, axis.z < 0.0f ? -1.0f : 1.0f);
  const float c = across * math::cos_turns(b), d = across * math::sin_turns(b);
  return {math::fma(c, u.x, math::fma(d, v.x, along * axis.x)),
          math::fma(c, u.y, math::fma(d, v.y, along * axis.y)),
          math::fma(c, u.z, math::fma(d, v.z, along * axis.z))};
}

}  // namespace astrolith
