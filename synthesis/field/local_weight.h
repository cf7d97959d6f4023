// The weight of a layer that is tied to a group of spheres (Locality in recipe/recipe.h; thesis 5.1): at one
// point, over many points at once, and bounds over boxes. With d the distance to the group's nearest sphere
// less the distance to the nearest other sphere, the weight is 1/2 - atan(d / width) / pi.
#pragma once

#include <limits>
#include <string>

#include "numerics/arrays.h"
#include "numerics/interval.h"
#include "numerics/scalar_math.h"
#include "recipe/recipe.h"

namespace astrolith {

// The smaller of `distance` and the distance from (x, y, z) to a sphere's surface, negative inside.
ASTROLITH_KERNEL float nearer_sphere(const Vec3f& center, float radius, float x, float y, float z,
                                     float distance) {
  const float dx = x - center.x, dy = y - center.y, dz = z - center.z;
  return math::min(distance, math::sqrt(math::fma(dx, dx, math::fma(dy, dy, dz * dz))) - radius);
}

// The weight, from the distance to the group's nearest sphere and the distance to the nearest other sphere.
ASTROLITH_KERNEL float local_weight(float group, float others, float inverse_width) {
  return math::fma(-2.0f, math::atan2_turns((group - others) * inverse_width, 1.0f), 0.5f);
}

// A metaball's sphere: its centre and radius, length units.
struct WeightSphere {
  Vec3f center;
  float radius;
};

struct LocalWeight {
  ArrayRange<WeightSphere> group, others;  // without others, the weight is 1 everywhere
  float inverse_width = 0.0f;              // per length unit
};

// Throws InputError when the body has no such group; the message begins with `layer`.
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

// Multiplies height[i] by the weight at p_i, for n points: the vectorised weight_at, with its bits.
void multiply_by_weight(const LocalWeight& weight, const ArrayView& arrays, int n, const float* x,
                        const float* y, const float* z, float* height);

// Bounds of the distance from a sphere's surface to the points of a box, in exact arithmetic.
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

// A bound of the rounding error of such a distance in float, length units.
ASTROLITH_HD inline double distance_rounding(const WeightSphere& s, const Box& box) {
  const Vec3d c{double{s.center.x}, double{s.center.y}, double{s.center.z}};
  return 2e-6 * (largest_coordinate(box) + norm(c) + double{s.radius});
}

// Bounds of the distance to the nearest of some spheres, and the largest rounding error of a distance.
// Without spheres the distance is infinite.
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

// Bounds of the weight at the float points of a box.
ASTROLITH_HD inline Interval bound_weight(const LocalWeight& weight, const ArrayView& arrays,
                                          const Box& box) {
  if (weight.others.count == 0) return {1.0, 1.0};
  const NearestBound group = bound_nearest(arrays[weight.group], weight.group.count, box);
  const NearestBound others = bound_nearest(arrays[weight.others], weight.others.count, box);
  const double rounding = 2.0 * std::max(group.rounding, others.rounding),
               width = double{weight.inverse_width};
  // The float arc tangent is within 2e-7 of the exact one.
  const auto at = [&](double difference) {
    const float ratio = static_cast<float>(clamped(difference * width, -1e30, 1e30));
    return double{local_weight(ratio, 0.0f, 1.0f)};
  };
  return {std::max(0.0, at(group.distance.high - others.distance.low + rounding) - 1e-6),
          std::min(1.0, at(group.distance.low - others.distance.high - rounding) + 1e-6)};
}

}  // namespace astrolith
