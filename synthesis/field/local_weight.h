// Where a layer that is tied to a group of spheres counts (recipe's Locality; thesis 5.1): at one point, over
// many points at once, and over boxes.
#pragma once

#include <limits>
#include <string>

#include "numerics/arrays.h"
#include "numerics/interval.h"
#include "numerics/scalar_math.h"
#include "recipe/recipe.h"

namespace astrolith {

// The distance from a sphere's surface, or a distance that is less.
ASTROLITH_KERNEL float nearer_sphere(const Vec3f& center, float radius, float x, float y, float z,
                                     float distance) {
  const float dx = x - center.x, dy = y - center.y, dz = z - center.z;
  return math::min(distance, math::sqrt(math::fma(dx, dx, math::fma(dy, dy, dz * dz))) - radius);
}

// The weight from the distances to the group's spheres and to all others.
ASTROLITH_KERNEL float local_weight(float group, float others, float inverse_width) {
  return math::fma(-2.0f, math::atan2_turns((group - others) * inverse_width, 1.0f), 0.5f);
}

// A sphere as points and boxes are measured from it.
struct WeightSphere {
  Vec3f center;
  float radius;
};

struct LocalWeight {
  ArrayRange<WeightSphere> group, others;  // no others: the weight is 1 everywhere
  float inverse_width = 0.0f;
};

// Throws InputError, with the layer's name, when the body has no such group.
LocalWeight make_local_weight(const Locality& locality, const MetaballBody& body, const std::string& layer,
                              ArrayStore& arrays);

// The weight at a point, in [0, 1].
ASTROLITH_HD inline float weight_at(const LocalWeight& weight, const ArrayView& arrays, const Vec3f& p) {
  const auto distance = [&](const ArrayRange<WeightSphere>& range) {
    const WeightSphere* spheres = arrays[range];
    float least = std::numeric_limits<float>::max();
    for (std::uint32_t s = 0; s < range.count; ++s) {
      least = nearer_sphere(spheres[s].center, spheres[s].radius, p.x, p.y, p.z, least);
    }
    return least;
  };
  if (weight.others.count == 0) return 1.0f;
  return local_weight(distance(weight.group), distance(weight.others), weight.inverse_width);
}

// height[i] *= the weight at p_i: the bits of weight_at, vectorised.
void multiply_by_weight(const LocalWeight& weight, const ArrayView& arrays, int n, const float* x,
                        const float* y, const float* z, float* height);

// The distances from a sphere's surface to the points of a box.
ASTROLITH_HD inline Interval sphere_distances(const WeightSphere& s, const Box& box) {
  const auto nearest = [](double c, double low, double high) {
    return std::max(std::max(low - c, c - high), 0.0);
  };
  const auto farthest = [](double c, double low, double high) {
    return std::max(std::fabs(c - low), std::fabs(c - high));
  };
  const Vec3d &a = box.min, &b = box.max, c{double{s.center.x}, double{s.center.y}, double{s.center.z}};
  const double radius = double{s.radius};
  return {norm(Vec3d{nearest(c.x, a.x, b.x), nearest(c.y, a.y, b.y), nearest(c.z, a.z, b.z)}) - radius,
          norm(Vec3d{farthest(c.x, a.x, b.x), farthest(c.y, a.y, b.y), farthest(c.z, a.z, b.z)}) - radius};
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

// The weight at every float point of a box.
ASTROLITH_HD inline Interval bound_weight(const LocalWeight& weight, const ArrayView& arrays,
                                          const Box& box) {
  if (weight.others.count == 0) return {1.0, 1.0};
  const NearestBound group = bound_nearest(arrays[weight.group], weight.group.count, box);
  const NearestBound others = bound_nearest(arrays[weight.others], weight.others.count, box);
  const double rounding = 2.0 * std::max(group.rounding, others.rounding),
               width = double{weight.inverse_width};
  // The arc tangent that points have is within 2e-7.
  const auto at = [&](double difference) {
    const float ratio = static_cast<float>(clamped(difference * width, -1e30, 1e30));
    return double{local_weight(ratio, 0.0f, 1.0f)};
  };
  return {std::max(0.0, at(group.distance.high - others.distance.low + rounding) - 1e-6),
          std::min(1.0, at(group.distance.low - others.distance.high - rounding) + 1e-6)};
}

}  // namespace astrolith
