#include "synthesis/spot_bounds.h"

#include <algorithm>
#include <cmath>

namespace astrolith {
namespace {

struct Range {
  double nearest = 0.0, farthest = 0.0;
};

// Of q^2 weighted along the kernel's axes, over the box.
struct SquaredDistances {
  Range plain, cut;  // q.q and q.V^-1 q
};

SquaredDistances squared_distances(const SpotKernel& k, const SpotImpulse& p, const Box& box) {
  const Vec3d low = box.min - Vec3d{p.x, p.y, p.z}, high = box.max - Vec3d{p.x, p.y, p.z};
  SquaredDistances squared;
  const auto add = [&](float along_x, float along_y, float along_z, float inverse_v) {
    const auto lower = [](float m, double a, double b) { return double{m} * (m > 0.0f ? a : b); };
    const double least =
        lower(along_x, low.x, high.x) + lower(along_y, low.y, high.y) + lower(along_z, low.z, high.z);
    const double most =
        lower(along_x, high.x, low.x) + lower(along_y, high.y, low.y) + lower(along_z, high.z, low.z);
    const double near = std::max({0.0, least, -most}), far = std::max(std::fabs(least), std::fabs(most));
    squared.plain.nearest += near * near;
    squared.plain.farthest += far * far;
    squared.cut.nearest += double{inverse_v} * near * near;
    squared.cut.farthest += double{inverse_v} * far * far;
  };
  add(k.xx, k.xy, k.xz, k.inverse_vx);
  add(k.yx, k.yy, k.yz, k.inverse_vy);
  add(k.zx, k.zy, k.zz, k.inverse_vz);
  return squared;
}

// K over squared distances, as spot_profile: one falls, the other rises to its ring and falls.
Interval bound_profile(const SpotKernel& k, const Range& q2) {
  const auto bowl = [&](double q) { return std::exp(-double{k.alpha} * q); };
  const auto ring = [&](double q) {
    const double log_ring = std::log(std::max(double{k.gamma} * q, 1e-38));
    return std::exp(-double{k.beta} * log_ring * log_ring);
  };
  const double at_ring = std::clamp(1.0 / double{k.gamma}, q2.nearest, q2.farthest);
  const Interval b{bowl(q2.farthest), bowl(q2.nearest)};
  const double g = k.gaussian, kappa = k.kappa;
  if (kappa == 0.0) return {std::min(g * b.low, g * b.high), std::max(g * b.low, g * b.high)};
  const Interval r{std::min(ring(q2.nearest), ring(q2.farthest)), ring(at_ring)};
  return {std::min(g * b.low, g * b.high) + std::min(kappa * r.low, kappa * r.high),
          std::max(g * b.low, g * b.high) + std::max(kappa * r.low, kappa * r.high)};
}

}  // namespace

Interval bound_spots(const SpotKernel& k, std::span<const SpotImpulse> impulses, const Box& box) {
  Interval sum;
  for (const SpotImpulse& impulse : impulses) {
    const auto [q2, cut] = squared_distances(k, impulse, box);
    if (cut.nearest > double{k.sigma} * (1.0 + kSpotSlack)) continue;
    Interval profile = bound_profile(k, {q2.nearest * (1.0 - kSpotSlack), q2.farthest * (1.0 + kSpotSlack)});
    if (cut.farthest > double{k.sigma} * (1.0 - kSpotSlack)) {
      profile = {std::min(0.0, profile.low), std::max(0.0, profile.high)};
    }
    sum.low += static_cast<double>(impulse.weight) * profile.low;
    sum.high += static_cast<double>(impulse.weight) * profile.high;
  }
  return sum;
}

}  // namespace astrolith
