// Bounds of spot noise over a box, for CPU and GPU.
#pragma once

#include "numerics/portable_double.h"
#include "synthesis/spots/spot_draw.h"

namespace astrolith {

// The largest numbers of cells, and of impulses on average, that are drawn at once.
inline constexpr double kMostSpotCells = 4096.0, kMostSpots = 65536.0;
inline constexpr double kSpotSlack = 1e-5;  // relative slack for the rounding of positions and kernels

// The ranges over a box of two squares in the axes of the kernel: q.q, and q.V^-1 q, which decides the cut.
struct SpotSquares {
  Interval plain, cut;
};
ASTROLITH_HD inline SpotSquares spot_squares(const SpotKernel& k, const SpotImpulse& p, const Box& box) {
  const Vec3d at{double{p.x}, double{p.y}, double{p.z}}, low = box.min - at, high = box.max - at;
  SpotSquares squares;
  const auto add = [&](float along_x, float along_y, float along_z, float inverse_v) {
    const auto lower = [](float m, double a, double b) { return double{m} * (m > 0.0f ? a : b); };
    const double least =
        lower(along_x, low.x, high.x) + lower(along_y, low.y, high.y) + lower(along_z, low.z, high.z);
    const double most =
        lower(along_x, high.x, low.x) + lower(along_y, high.y, low.y) + lower(along_z, high.z, low.z);
    const double nearest = std::max(std::max(0.0, least), -most),
                 farthest = std::max(std::fabs(least), std::fabs(most));
    squares.plain.low += nearest * nearest;
    squares.plain.high += farthest * farthest;
    squares.cut.low += double{inverse_v} * nearest * nearest;
    squares.cut.high += double{inverse_v} * farthest * farthest;
  };
  add(k.xx, k.xy, k.xz, k.inverse_vx);
  add(k.yx, k.yy, k.yz, k.inverse_vy);
  add(k.zx, k.zy, k.zz, k.inverse_vz);
  return squares;
}

// The range of spot_profile() over squared distances. One term falls with the distance; the other rises up to
// its ring and falls beyond.
ASTROLITH_HD inline Interval bound_spot_profile(const SpotKernel& k, const Interval& q2) {
  const auto bowl = [&](double q) { return portable::exp(-double{k.alpha} * q); };
  const auto ring = [&](double q) {
    const double log_ring = portable::log(std::max(double{k.gamma} * q, 1e-38));
    return portable::exp(-double{k.beta} * log_ring * log_ring);
  };
  const Interval fall = scaled(double{k.gaussian}, {bowl(q2.high), bowl(q2.low)});
  if (k.kappa == 0.0f) return fall;
  const double at_ring = clamped(1.0 / double{k.gamma}, q2.low, q2.high);
  return plus(fall, scaled(double{k.kappa}, {std::min(ring(q2.low), ring(q2.high)), ring(at_ring)}));
}

// Bounds the sum of spots of one kind over a box. Spots are added one at a time.
struct SpotSumBound {
  const SpotKind& kind;
  const Box& box;
  Interval sum{};

  ASTROLITH_HD void add(const SpotImpulse& impulse) {
    const SpotKernel& k = kind.kernel;
    const double sigma = double{k.sigma};
    const SpotSquares q2 = spot_squares(k, impulse, box);
    if (q2.cut.low > sigma * (1.0 + kSpotSlack)) return;
    Interval profile =
        bound_spot_profile(k, {q2.plain.low * (1.0 - kSpotSlack), q2.plain.high * (1.0 + kSpotSlack)});
    if (q2.cut.high > sigma * (1.0 - kSpotSlack)) {
      profile = {std::min(0.0, profile.low), std::max(0.0, profile.high)};
    }
    sum.low += double{impulse.weight} * profile.low;
    sum.high += double{impulse.weight} * profile.high;
  }
  ASTROLITH_HD Interval clipped() const {
    const double clip = double{kind.clip};
    return {clamped(sum.low, -clip, clip), clamped(sum.high, -clip, clip)};
  }
};

// Whether too many impulses lie around a box to be drawn at once.
ASTROLITH_HD inline bool too_many_spots(const SpotKind& kind, const Box& box) {
  const double cells = spot_cells_around(kind, box).count();
  return cells > kMostSpotCells || cells * kind.lattice.probability * kind.lattice.density > kMostSpots;
}

// An interval that holds the clipped sum of all spots of a kind over the box. If too many cells lie around
// the box, the impulses are not drawn, and the interval is the range of the clip.
ASTROLITH_HD inline Interval bound_drawn_spots(const SpotKind& kind, const std::uint32_t* thresholds,
                                               const Box& box) {
  const double clip = double{kind.clip};
  if (too_many_spots(kind, box)) return {-clip, clip};
  SpotSumBound bound{kind, box};
  for_each_spot(kind, thresholds, box, [&](const SpotImpulse& impulse) { bound.add(impulse); });
  return bound.clipped();
}

}  // namespace astrolith
