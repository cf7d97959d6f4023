// The kernel of spot noise (thesis eq. 5.5 and 5.6) at one point.
#pragma once

#include "numerics/host_device.h"
#include "numerics/scalar_math.h"

namespace astrolith {

struct SpotImpulse {
  float x, y, z;  // length units
  float weight;
};

struct SpotKernel {
  float scale;               // lacunarity^j / size, per length unit
  float gaussian, alpha;     // gaussian is in length units, amplitude and sign included
  float kappa, beta, gamma;  // so is kappa
  float inverse_vx, inverse_vy, inverse_vz, sigma;
};

// K at squared distance q2, without the cut. The thesis prints beta = -10 in a figure for what the formula
// needs as +10.
ASTROLITH_KERNEL float spot_profile(const SpotKernel& k, float q2) {
  const float log_ring = math::log(k.gamma * q2);
  return math::fma(k.gaussian, math::exp(-k.alpha * q2),
                   k.kappa * math::exp(-k.beta * (log_ring * log_ring)));
}

// weight K(p - impulse), exactly zero beyond sigma.
ASTROLITH_KERNEL float spot_height(const SpotKernel& k, const SpotImpulse& impulse, float x, float y,
                                   float z) {
  const float dx = k.scale * (x - impulse.x), dy = k.scale * (y - impulse.y), dz = k.scale * (z - impulse.z);
  const float xx = dx * dx, yy = dy * dy, zz = dz * dz;
  const float inside = math::fma(xx, k.inverse_vx, math::fma(yy, k.inverse_vy, zz * k.inverse_vz));
  const float height = impulse.weight * spot_profile(k, xx + (yy + zz));
  return inside <= k.sigma ? height : 0.0f;
}

}  // namespace astrolith
