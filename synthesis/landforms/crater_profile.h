// The relief of one crater at one point; CraterProfile in recipe/landforms.h states the equations.
#pragma once

#include "numerics/host_device.h"
#include "numerics/scalar_math.h"

namespace astrolith {

// A crater with the constants that its evaluation needs. x is the distance from the centre over the radius.
struct CraterKernel {
  float x, y, z;                 // centre on the bare surface, length units
  float inverse_radius_squared;  // 1 / radius^2 of the rim's crest, per squared length unit
  float depth, rim_height;       // length units
  float sharpness;
  float smoothing;                    // k, length units
  float extent_squared, extent;       // in radii
  float inverse_flank_width;          // 1 / (extent - 1)
  float flank;                        // exponent of the flank's fall
  float terraces;                     // number of steps, a whole number
  float peak_height;                  // length units
  float inverse_peak_radius_squared;  // 1 / peak_radius^2, with the peak's radius in radii
  float base;                         // elevation at the centre before the crater, length units
};

// The polynomial smooth minimum: exact where |a - b| >= k, up to k/4 below the smaller elsewhere.
ASTROLITH_KERNEL float smooth_min(float a, float b, float k) {
  const float share = math::clamp(math::fma(0.5f, (b - a) / math::max(k, 1e-30f), 0.5f), 0.0f, 1.0f);
  return math::fma(share, a, (1.0f - share) * b) - k * (share * (1.0f - share));
}
ASTROLITH_KERNEL float smooth_max(float a, float b, float k) { return -smooth_min(-a, -b, k); }

// A staircase from (0, 0) to (1, 1) with a tread wherever steps * v is whole. Outside [0, 1], or without
// steps, the result is v. It never falls with v.
ASTROLITH_KERNEL float terraced(float v, float steps) {
  const float n = math::max(steps, 1.0f);
  const float whole = math::floor(n * v), rest = math::fma(n, v, -whole);
  const float riser = rest * rest * math::fma(-2.0f, rest, 3.0f);
  const bool on_wall = steps > 0.0f && v > 0.0f && v < 1.0f;
  return on_wall ? (whole + riser) / n : v;
}

// Cavity, rim and peak above the surroundings at x^2, length units.
ASTROLITH_KERNEL float crater_cavity(const CraterKernel& c, float x_squared) {
  const float up_the_wall = terraced(math::fma(c.sharpness, x_squared - 1.0f, 1.0f), c.terraces);
  return math::fma(c.depth + c.rim_height, up_the_wall, -c.depth);
}

ASTROLITH_KERNEL float crater_rim(const CraterKernel& c, float x_squared) {
  const float left = (c.extent - math::sqrt(x_squared)) * c.inverse_flank_width;
  return left > 0.0f ? c.rim_height * math::exp(c.flank * math::log(math::max(left, 1e-30f))) : 0.0f;
}

ASTROLITH_KERNEL float crater_peak(const CraterKernel& c, float x_squared) {
  const float left = math::max(1.0f - x_squared * c.inverse_peak_radius_squared, 0.0f);
  return c.peak_height * (left * left);
}

// The height above the surroundings, length units; exactly zero beyond the extent.
ASTROLITH_KERNEL float crater_height(const CraterKernel& c, float x_squared) {
  const float pit = smooth_min(crater_cavity(c, x_squared), crater_rim(c, x_squared), c.smoothing);
  const float height = smooth_max(pit, -c.depth, c.smoothing) + crater_peak(c, x_squared);
  return x_squared < c.extent_squared ? height : 0.0f;
}

// The elevation at a point after the crater: within the rim the old relief fades towards the base with x^2.
ASTROLITH_KERNEL float cratered(const CraterKernel& c, float x_squared, float elevation) {
  const float kept = math::min(x_squared, 1.0f);
  const float changed = math::fma(elevation - c.base, kept, c.base) + crater_height(c, x_squared);
  return x_squared < c.extent_squared ? changed : elevation;
}

// x^2 at a point.
ASTROLITH_KERNEL float crater_distance_squared(const CraterKernel& c, float x, float y, float z) {
  const float dx = x - c.x, dy = y - c.y, dz = z - c.z;
  return math::fma(dx, dx, math::fma(dy, dy, dz * dz)) * c.inverse_radius_squared;
}

}  // namespace astrolith
