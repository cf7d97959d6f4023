// The Gabor kernel, for the plane and for surfaces. The code is plain and scalar, for loops and GPUs.
//
// In units of 1/a, where a is the bandwidth of the kernel (thesis eq. 5.8 to 5.11),
//
//   k(u, v, n) = e(u) e(v) W(n) cos(2 pi (f_u u + f_v v) + phase),    e(u) = exp(-pi u^2) w(u)
//
// The window w is 1 up to 0.7 of the reach, and falls to 0 with zero slope at the reach, 1.4. The kernel is
// C1, and the power spectrum of e(u) e(v) is that of the ideal Gaussian within 0.8 % (relative L2, at equal
// variance). Along the normal, W(n) = (1 - (a n)^2)^2 within 1/a of the tangent plane of the impulse, and 0
// beyond. W is C1 too.
#pragma once

#include "numerics/host_device.h"
#include "numerics/scalar_math.h"
#include "numerics/vec3.h"

namespace astrolith {

inline constexpr float kGaborReach = 1.4f;  // reach of e, in units of 1/a: half the side of the support
inline constexpr float kGaborSlabReach = 1.0f;

// The integrals of e^2 over u and of W^2 over n, in units of 1/a.
inline constexpr double kGaborProfileEnergy = 0.70704965;
inline constexpr double kGaborSlabEnergy = 256.0 / 315.0;

// The area of the circle on which a Gaussian kernel has 5 % of its peak, in units of 1/a^2. Impulses "under
// one kernel" are counted in this circle, as in Lagae et al. 2009.
inline constexpr double kGaborKernelArea = 2.99573227;
// The effective thickness of the slab for the variance, (integral of W^2)^2 / integral of W^4, in units of
// 1/a.
inline constexpr double kGaborSlabThickness = 1.10250;

// The sides of cells, in units of 1/a. With the same number of impulses in every cell, the fourth cumulant of
// the noise is
//
//   lambda (3/8 int k^4 - 3/4 sum_cells cell_volume (mean of k^2 in the cell)^2).
//
// Small cells make it negative (stratification), large cells positive (Poisson). At the sides below it
// vanishes. The noise then has the kurtosis of a Gaussian for any number of impulses.
inline constexpr double kGaborPlaneCell = 0.9368;
inline constexpr double kGaborSpaceCell = 0.7543;

// The window w(u) as a function of u^2.
ASTROLITH_KERNEL float gabor_window(float u2) {
  constexpr float kReach2 = kGaborReach * kGaborReach;
  constexpr float kScale = 1.0f / (kReach2 * (1.0f - 0.49f));
  const float t = math::clamp((kReach2 - u2) * kScale, 0.0f, 1.0f);
  return t * t * math::fma(-2.0f, t, 3.0f);
}

// The profile e(u). It is exactly 0 beyond the reach.
ASTROLITH_KERNEL float gabor_profile(float u) {
  const float u2 = u * u;
  return gabor_window(u2) * math::exp(-3.14159265f * u2);
}

// An impulse on a surface: its position, its tangent frame and its lobe.
struct GaborImpulse {
  float x, y, z;                   // length units
  float ux, uy, uz;                // first tangent axis times a
  float vx, vy, vz;                // second tangent axis times a
  float nx, ny, nz;                // normal times a
  float frequency_u, frequency_v;  // in units of a
  float phase;                     // turns
};

// The kernel of an impulse at the point (x, y, z), without its amplitude.
ASTROLITH_KERNEL float gabor_kernel(const GaborImpulse& impulse, float x, float y, float z) {
  const float dx = x - impulse.x, dy = y - impulse.y, dz = z - impulse.z;
  const float u = math::fma(dx, impulse.ux, math::fma(dy, impulse.uy, dz * impulse.uz));
  const float v = math::fma(dx, impulse.vx, math::fma(dy, impulse.vy, dz * impulse.vz));
  const float n = math::fma(dx, impulse.nx, math::fma(dy, impulse.ny, dz * impulse.nz));
  const float u2 = u * u, v2 = v * v;
  const float slab = math::max(math::fma(-n, n, 1.0f), 0.0f);
  const float envelope = gabor_window(u2) * gabor_window(v2) * (slab * slab);
  const float turns = math::fma(impulse.frequency_u, u, math::fma(impulse.frequency_v, v, impulse.phase));
  // Where the windows are 0 exp() stays finite, and the angle has no effect.
  return envelope * math::exp(-3.14159265f * (u2 + v2)) * math::cos_turns(turns);
}

// The value of a kernel, and its gradient per length unit.
struct GaborSample {
  float value;
  Vec3f slope;
};

// The window w(u) and its derivative.
struct WindowSample {
  float value, slope;
};
ASTROLITH_KERNEL WindowSample gabor_window_with_slope(float u) {
  constexpr float kReach2 = kGaborReach * kGaborReach;
  constexpr float kScale = 1.0f / (kReach2 * (1.0f - 0.49f));
  const float t = math::clamp((kReach2 - u * u) * kScale, 0.0f, 1.0f);
  return {t * t * math::fma(-2.0f, t, 3.0f), -12.0f * kScale * u * (t * (1.0f - t))};
}

// gabor_kernel(), bit for bit, with its gradient:
//
//   d/du (w exp(-pi u^2) cos) = exp(-pi u^2) ((w' - 2 pi u w) cos - 2 pi f w sin).
ASTROLITH_KERNEL GaborSample gabor_kernel_with_slope(const GaborImpulse& impulse, float x, float y, float z) {
  constexpr float kTwoPi = 6.28318531f;
  const float dx = x - impulse.x, dy = y - impulse.y, dz = z - impulse.z;
  const float u = math::fma(dx, impulse.ux, math::fma(dy, impulse.uy, dz * impulse.uz));
  const float v = math::fma(dx, impulse.vx, math::fma(dy, impulse.vy, dz * impulse.vz));
  const float n = math::fma(dx, impulse.nx, math::fma(dy, impulse.ny, dz * impulse.nz));
  const WindowSample wu = gabor_window_with_slope(u), wv = gabor_window_with_slope(v);
  const float slab = math::max(math::fma(-n, n, 1.0f), 0.0f), slab2 = slab * slab;
  const float gaussian = math::exp(-3.14159265f * (u * u + v * v));
  const float turns = math::fma(impulse.frequency_u, u, math::fma(impulse.frequency_v, v, impulse.phase));
  const float cosine = math::cos_turns(turns), sine = kTwoPi * math::sin_turns(turns);
  const float windows = wu.value * wv.value;
  const float along_u =
      math::fma(math::fma(-kTwoPi * u, wu.value, wu.slope), cosine, -impulse.frequency_u * wu.value * sine);
  const float along_v =
      math::fma(math::fma(-kTwoPi * v, wv.value, wv.slope), cosine, -impulse.frequency_v * wv.value * sine);
  const float gu = gaussian * slab2 * wv.value * along_u, gv = gaussian * slab2 * wu.value * along_v;
  const float gn = gaussian * windows * cosine * (-4.0f * n * slab);
  const auto slope = [&](float ax, float ay, float az) {
    return math::fma(gu, ax, math::fma(gv, ay, gn * az));
  };
  return {windows * slab2 * gaussian * cosine,
          {slope(impulse.ux, impulse.vx, impulse.nx), slope(impulse.uy, impulse.vy, impulse.ny),
           slope(impulse.uz, impulse.vz, impulse.nz)}};
}

}  // namespace astrolith
