// What is certain, over boxes, about how layers join those before them (layer_join.h) and where they count
// (local_weight.h), for CPU and GPU.
#pragma once

#include "numerics/interval.h"
#include "synthesis/field/layer_join.h"

namespace astrolith {

ASTROLITH_HD inline double rounded_max(double a, double b, double width) {
  const double d = std::fabs(a - b);
  return std::max(a, b) + 0.5 * (std::sqrt(d * d + width * width) - d);
}

// What of a layer's combination counts.
struct JoinKind {
  Combine kind = Combine::kAdd;
  bool intersection = false;
  double width = 0.0;  // of a blend
};

// What a layer makes of one elevation where its weight is 1.
ASTROLITH_HD inline double joined_fully(const JoinKind& how, double before, double height) {
  if (how.kind == Combine::kAdd) return before + height;
  if (how.kind == Combine::kReplace) return height;
  if (how.kind != Combine::kBlend) return before;
  const double sign = how.intersection ? -1.0 : 1.0;
  return sign * rounded_max(sign * before, sign * height, how.width);
}

// Each is monotonic in the elevation before, in the height and in the weight.
ASTROLITH_HD inline Interval bound_joined(const JoinKind& how, const Interval& weight, const Interval& before,
                                          const Interval& height) {
  const double low = joined_fully(how, before.low, height.low);
  const double high = joined_fully(how, before.high, height.high);
  const auto mixed = [](double w, double a, double b) { return (1.0 - w) * a + w * b; };
  return {std::min(mixed(weight.low, before.low, low), mixed(weight.high, before.low, low)),
          std::max(mixed(weight.low, before.high, high), mixed(weight.high, before.high, high))};
}

// The weight of a mask for heights of an interval.
ASTROLITH_HD inline Interval bound_mask(float from, float to, const Interval& heights) {
  const auto at = [&](double height) {
    const double t = clamped((height - double{from}) / (double{to} - double{from}), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
  };
  const double a = at(heights.low), b = at(heights.high);
  return {std::max(0.0, std::min(a, b) - 1e-5), std::min(1.0, std::max(a, b) + 1e-5)};
}

// Of the distances from a sphere's surface to the points of a box.
ASTROLITH_HD inline Interval sphere_distances(const WeightSphere& s, const Box& box) {
  const auto near = [](double c, double low, double high) {
    return std::max(std::max(low - c, c - high), 0.0);
  };
  const auto far = [](double c, double low, double high) {
    return std::max(std::fabs(c - low), std::fabs(c - high));
  };
  const Vec3d &a = box.min, &b = box.max, c{double{s.center.x}, double{s.center.y}, double{s.center.z}};
  const double radius = double{s.radius};
  return {norm(Vec3d{near(c.x, a.x, b.x), near(c.y, a.y, b.y), near(c.z, a.z, b.z)}) - radius,
          norm(Vec3d{far(c.x, a.x, b.x), far(c.y, a.y, b.y), far(c.z, a.z, b.z)}) - radius};
}

// How far a distance in float may be from the exact one.
ASTROLITH_HD inline double distance_rounding(const WeightSphere& s, const Box& box) {
  const Vec3d c{double{s.center.x}, double{s.center.y}, double{s.center.z}};
  return 2e-6 * (largest_coordinate(box) + norm(c) + double{s.radius});
}

// The distance to the nearest of some spheres, and the largest rounding of one; nothing is nearest of none.
struct NearestBound {
  Interval distance{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  double rounding = 0.0;
};
ASTROLITH_HD inline NearestBound bound_nearest(const WeightSphere* spheres, std::uint32_t count,
                                               const Box& box) {
  NearestBound nearest;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Interval d = sphere_distances(spheres[i], box);
    nearest.distance = {std::min(nearest.distance.low, d.low), std::min(nearest.distance.high, d.high)};
    nearest.rounding = std::max(nearest.rounding, distance_rounding(spheres[i], box));
  }
  return nearest;
}

// The weight at every float point of a box, from the nearest of a group's spheres and of all others.
ASTROLITH_HD inline Interval bound_local_weight(const NearestBound& near, const NearestBound& others,
                                                float inverse_width) {
  const double rounding = 2.0 * std::max(near.rounding, others.rounding), width = double{inverse_width};
  // Within 2e-7, by the arc tangent that points have.
  const auto weight = [&](double difference) {
    const float ratio = static_cast<float>(clamped(difference * width, -1e30, 1e30));
    return double{local_weight(ratio, 0.0f, 1.0f)};
  };
  return {std::max(0.0, weight(near.distance.high - others.distance.low + rounding) - 1e-6),
          std::min(1.0, weight(near.distance.low - others.distance.high - rounding) + 1e-6)};
}

}  // namespace astrolith
