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

// Some of the spheres, which follow one another in their array and lie close together.
struct WeightRun {
  Box centers;  // holds the centres
  double largest_radius;
  std::uint32_t first, end;  // numbers of the spheres
};

// Spheres in runs of about as many spheres as there are runs. The search for the nearest sphere looks at all
// runs and at the spheres of few, so that it grows with the square root of the number of spheres.
struct WeightSpheres {
  ArrayRange<WeightSphere> spheres;
  ArrayRange<WeightRun> runs;
  double farthest = 0.0;  // the largest sum of |centre| and radius
};

struct LocalWeight {
  WeightSpheres group, others;  // without others, the weight is 1 everywhere
  float inverse_width = 0.0f;   // per length unit
};

// Throws InputError when the body has no such group; the message begins with `layer`.
LocalWeight make_local_weight(const Locality& locality, const MetaballBody& body, const std::string& layer,
                              ArrayStore& arrays);

// The weight at a point, in [0, 1].
ASTROLITH_HD inline float weight_at(const LocalWeight& weight, const ArrayView& arrays, const Vec3f& p) {
  const auto distance = [&](const WeightSpheres& set) {
    const WeightSphere* spheres = arrays[set.spheres];
    float least = std::numeric_limits<float>::max();
    for (std::uint32_t s = 0; s < set.spheres.count; ++s) {
      least = nearer_sphere(spheres[s].center, spheres[s].radius, p.x, p.y, p.z, least);
    }
    return least;
  };
  if (weight.others.spheres.count == 0) return 1.0f;
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

// A bound of the rounding error of the distances in float from points of the box to the spheres of a set,
// length units.
ASTROLITH_HD inline double distance_rounding(const WeightSpheres& set, const Box& box) {
  return 2e-6 * (largest_coordinate(box) + set.farthest);
}

// A lower bound of the distance from the spheres of a run to the points of a box.
ASTROLITH_HD inline double least_distance(const WeightRun& run, const Box& box) {
  const Vec3d &a = box.min, &b = box.max, &low = run.centers.min, &high = run.centers.max;
  const auto gap = [](double a0, double a1, double b0, double b1) {
    return std::max(std::max(a0 - b1, b0 - a1), 0.0);
  };
  const Vec3d between{gap(a.x, b.x, low.x, high.x), gap(a.y, b.y, low.y, high.y),
                      gap(a.z, b.z, low.z, high.z)};
  return (1.0 - 1e-12) * norm(between) - run.largest_radius;
}

// Calls visit(run) for all runs of a set but those of which every sphere is farther than limit() from every
// point of the box. The nearest run comes first, so that the visits can lower the limit. `limit` may shrink
// from visit to visit.
template <class Limit, class Visit>
ASTROLITH_HD inline void for_each_near_run(const WeightRun* runs, std::uint32_t count, const Box& box,
                                           Limit&& limit, Visit&& visit) {
  std::uint32_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = 0; i < count; ++i) {
    const double distance = least_distance(runs[i], box);
    if (distance < least) least = distance, nearest = i;
  }
  if (count > 0) visit(runs[nearest]);
  for (std::uint32_t i = 0; i < count; ++i) {
    if (i != nearest && least_distance(runs[i], box) <= limit()) visit(runs[i]);
  }
}

// Bounds of the distance to the nearest of some spheres. Without spheres it is infinite.
ASTROLITH_HD inline Interval bound_nearest(const WeightSpheres& set, const ArrayView& arrays,
                                           const Box& box) {
  Interval nearest{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  const WeightSphere* spheres = arrays[set.spheres];
  for_each_near_run(
      arrays[set.runs], set.runs.count, box, [&] { return nearest.high; },
      [&](const WeightRun& run) {
        for (std::uint32_t i = run.first; i < run.end; ++i) {
          const Interval d = sphere_distances(spheres[i], box);
          nearest = {std::min(nearest.low, d.low), std::min(nearest.high, d.high)};
        }
      });
  return nearest;
}

// Bounds of the weight at the float points of a box.
ASTROLITH_HD inline Interval bound_weight(const LocalWeight& weight, const ArrayView& arrays,
                                          const Box& box) {
  if (weight.others.spheres.count == 0) return {1.0, 1.0};
  const Interval group = bound_nearest(weight.group, arrays, box);
  const Interval others = bound_nearest(weight.others, arrays, box);
  const double rounding = 2.0 * std::max(distance_rounding(weight.group, box),
                                         distance_rounding(weight.others, box)),
               width = double{weight.inverse_width};
  // The float arc tangent is within 2e-7 of the exact one.
  const auto at = [&](double difference) {
    const float ratio = static_cast<float>(clamped(difference * width, -1e30, 1e30));
    return double{local_weight(ratio, 0.0f, 1.0f)};
  };
  return {std::max(0.0, at(group.high - others.low + rounding) - 1e-6),
          std::min(1.0, at(group.low - others.high - rounding) + 1e-6)};
}

}  // namespace astrolith
