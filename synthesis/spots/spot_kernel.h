// The kernel of spot noise (thesis eq. 5.3, 5.5 and 5.6) at one point.
#pragma once

#include "numerics/host_device.h"
#include "numerics/scalar_math.h"

namespace astrolith {

// The position of a spot, and its weight.
struct SpotImpulse {
  float x, y, z;  // length units
  float weight;
};

// The kernel K(p) = gaussian exp(-alpha q.q) + kappa exp(-beta log^2(gamma q.q)) with q = matrix p. It is cut
// where q.V^-1 q > sigma; V is a diagonal matrix of variances.
struct SpotKernel {
  float xx, xy, xz, yx, yy, yz, zx, zy, zz;  // matrix from length units to q: it rotates, then scales
  float gaussian, alpha;                     // gaussian in length units, with amplitude and sign
  float kappa, beta, gamma;                  // kappa in length units, with amplitude and sign
  float inverse_vx, inverse_vy, inverse_vz, sigma;
};

// The kernel K at the squared distance q2, without the cut. The thesis prints beta = -10 in a figure where
// the formula needs +10.
ASTROLITH_KERNEL float spot_profile(const SpotKernel& k, float q2) {
  const float log_ring = math::log(k.gamma * q2);
  return math::fma(k.gaussian, math::exp(-k.alpha * q2),
                   k.kappa * math::exp(-k.beta * (log_ring * log_ring)));
}

// Returns weight K(p - impulse), length units. It is exactly 0 where q.V^-1 q > sigma.
ASTROLITH_KERNEL float spot_height(const SpotKernel& k, const SpotImpulse& impulse, float x, float y,
                                   float z) {
  const float dx = x - impulse.x, dy = y - impulse.y, dz = z - impulse.z;
  const float qx = math::fma(k.xx, dx, math::fma(k.xy, dy, k.xz * dz));
  const float qy = math::fma(k.yx, dx, math::fma(k.yy, dy, k.yz * dz));
  const float qz = math::fma(k.zx, dx, math::fma(k.zy, dy, k.zz * dz));
  const float xx = qx * qx, yy = qy * qy, zz = qz * qz;
  const float inside = math::fma(xx, k.inverse_vx, math::fma(yy, k.inverse_vy, zz * k.inverse_vz));
  const float height = impulse.weight * spot_profile(k, xx + (yy + zz));
  return inside <= k.sigma ? height : 0.0f;
}

}  // namespace astrolith
