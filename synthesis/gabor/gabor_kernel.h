// The Gabor kernels of the plane and of surfaces. The code is plain and scalar, for loops and GPUs.
//
// Lengths are in units of 1/a, where a is the bandwidth of the kernel (thesis eq. 5.8 to 5.11). On the plane,
//
//   k(u, v) = e(u) e(v) cos(2 pi (f_u u + f_v v) + phase),    e(u) = exp(-pi u^2) w(u)
//
// The window w is 1 up to 0.7 of the reach, and falls to 0 with zero slope at the reach, 1.4. The kernel is
// C1, and its power spectrum without the cosine is that of the ideal Gaussian within 0.8 % (relative L2, at
// equal variance).
//
// On a surface the kernel ends on the circle of radius R = 1.15 around its impulse, and has no exponential:
//
//   k(u, v, n) = P(t) W(n) cos(2 pi (f_u u + f_v v) + phase),    t = max(0, 1 - (u^2 + v^2) / R^2)
//   P(t) = t^2 (1.81 - 4.23 t + 3.42 t^2),    W(n) = max(0, 1 - n^8)^2
//
// P is the polynomial of its form whose power spectrum is nearest to that of the Gaussian: within 0.8 %
// again, from a support of 0.53 times the area. W is wide and steep, since impulses whose weight is small
// cost as much as others. P and W are C1.
#pragma once

#include "numerics/host_device.h"
#include "numerics/scalar_math.h"
#include "numerics/vec3.h"

namespace astrolith {

inline constexpr float kGaborReach = 1.4f;       // reach of e, in units of 1/a: half the side of the support
inline constexpr float kGaborDiscReach = 1.15f;  // reach of P
inline constexpr float kGaborSlabReach = 1.0f;   // reach of W

// The integrals of e^2 over u, of P^2 over the plane and of W^2 over n, in units of 1/a.
inline constexpr double kGaborProfileEnergy = 0.70704965;
inline constexpr double kGaborDiscEnergy = 0.46045977;
inline constexpr double kGaborSlabEnergy = 1.5575995247;

// The area of the circle on which a Gaussian kernel has 5 % of its peak, in units of 1/a^2. Impulses "under
// one kernel" are counted in this circle, as in Lagae et al. 2009.
inline constexpr double kGaborKernelArea = 2.99573227;
// The effective thickness of the slab for the variance, (integral of W^2)^2 / integral of W^4, in units of
// 1/a.
inline constexpr double kGaborSlabThickness = 1.684825;

// The sides of cells, in units of 1/a. With the same number of impulses in every cell, the fourth cumulant of
// the noise is
//
//   lambda (3/8 int k^4 - 3/4 sum_cells cell_volume (mean of k^2 in the cell)^2).
//
// Small cells make it negative (stratification), large cells positive (Poisson). On the plane it vanishes at
// the side below. The noise then has the kurtosis of a Gaussian for any number of impulses. In space it
// vanishes at 0.79. At 0.779, three impulses in each cell are 32 under a kernel, and the kurtosis is 2.998.
inline constexpr double kGaborPlaneCell = 0.9368;
inline constexpr double kGaborSpaceCell = 0.779;

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

// An impulse on a surface: its position, the wave vector of its lobe, its normal and its phase.
struct GaborImpulse {
  float x, y, z;     // length units
  float fx, fy, fz;  // wave vector in the tangent plane, cycles per length unit
  float nx, ny, nz;  // normal times a
  float phase;       // turns
};

// The polynomial P and its derivative, for t >= 0.
ASTROLITH_KERNEL float gabor_disc(float t) {
  return t * t * math::fma(math::fma(3.42f, t, -4.23f), t, 1.81f);
}
ASTROLITH_KERNEL float gabor_disc_slope(float t) {
  return t * math::fma(math::fma(13.68f, t, -12.69f), t, 3.62f);
}

// The factor a^2 / R^2 that kernels of bandwidth a (cycles per length unit) need.
ASTROLITH_KERNEL float gabor_disc_scale(float a) {
  constexpr float kScale = 1.0f / (kGaborDiscReach * kGaborDiscReach);
  return a * a * kScale;
}

// cos(2 pi x) for |x| < 2^22 with an absolute error below 2e-6: math::cos_turns() in fewer operations.
ASTROLITH_KERNEL float gabor_cosine(float turns) {
  const float r = turns - math::round_even(turns);  // [-1/2, 1/2]
  const float z = r * r;
  float p = -21.0711056f;  // Chebyshev over z in [0, 1/4], within 1e-6
  p = math::fma(p, z, 58.7904921f);
  p = math::fma(p, z, -85.2716215f);
  p = math::fma(p, z, 64.9286574f);
  p = math::fma(p, z, -19.7389804f);
  return math::fma(p, z, 0.999999211f);
}

// Where a point lies in the support of an impulse.
struct GaborPlace {
  float dx, dy, dz;  // offset from the impulse, length units
  float n;           // offset along the normal, in units of 1/a
  float t;           // of P
  float slab;        // max(0, 1 - n^8)
  float turns;       // angle of the wave
};
ASTROLITH_KERNEL GaborPlace gabor_place(const GaborImpulse& k, float disc_scale, float x, float y, float z) {
  constexpr float kScale = 1.0f / (kGaborDiscReach * kGaborDiscReach);
  const float dx = x - k.x, dy = y - k.y, dz = z - k.z;
  const float r2 = math::fma(dx, dx, math::fma(dy, dy, dz * dz));
  const float n = math::fma(dx, k.nx, math::fma(dy, k.ny, dz * k.nz));
  const float n2 = n * n, n4 = n2 * n2;
  const float t = math::max(math::fma(-disc_scale, r2, math::fma(kScale, n2, 1.0f)), 0.0f);
  const float slab = math::max(math::fma(-n4, n4, 1.0f), 0.0f);
  return {dx, dy, dz, n, t, slab, math::fma(dx, k.fx, math::fma(dy, k.fy, math::fma(dz, k.fz, k.phase)))};
}

// The kernel of an impulse at the point (x, y, z), without its amplitude. `disc_scale` is gabor_disc_scale().
ASTROLITH_KERNEL float gabor_kernel(const GaborImpulse& impulse, float disc_scale, float x, float y,
                                    float z) {
  const GaborPlace at = gabor_place(impulse, disc_scale, x, y, z);
  // Where the envelope is 0 the other factors are finite.
  return gabor_disc(at.t) * (at.slab * at.slab) * gabor_cosine(at.turns);
}

// The value of a kernel, and its gradient per length unit.
struct GaborSample {
  float value;
  Vec3f slope;
};

// gabor_kernel(), bit for bit, with its gradient. With d the offset, N the normal times a and F the wave
// vector, the gradients of the factors are
//
//   grad P = P'(t) (2 / R^2) (n N - a^2 d),  grad W = -16 n^7 (1 - n^8) N,  grad cos = -2 pi sin F.
ASTROLITH_KERNEL GaborSample gabor_kernel_with_slope(const GaborImpulse& impulse, float disc_scale, float x,
                                                     float y, float z) {
  constexpr float kTwoPi = 6.28318531f;
  constexpr float kTwoScale = 2.0f / (kGaborDiscReach * kGaborDiscReach);
  const GaborPlace at = gabor_place(impulse, disc_scale, x, y, z);
  const float disc = gabor_disc(at.t), slab2 = at.slab * at.slab;
  const float cosine = gabor_cosine(at.turns), sine = math::sin_turns(at.turns);
  const float steep = gabor_disc_slope(at.t) * slab2 * cosine;
  const float along_d = -2.0f * disc_scale * steep;
  const float n2 = at.n * at.n;
  const float along_n =
      at.n * math::fma(kTwoScale, steep, -16.0f * (n2 * n2 * n2) * (at.slab * disc * cosine));
  const float along_f = -kTwoPi * sine * (disc * slab2);
  const auto slope = [&](float d, float n, float f) {
    return math::fma(along_d, d, math::fma(along_n, n, along_f * f));
  };
  return {disc * slab2 * cosine,
          {slope(at.dx, impulse.nx, impulse.fx), slope(at.dy, impulse.ny, impulse.fy),
           slope(at.dz, impulse.nz, impulse.fz)}};
}

}  // namespace astrolith
