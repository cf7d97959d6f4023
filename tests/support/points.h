// Points of tests: by chance, and as floats one axis at a time, as fields and noises take them.
#pragma once

#include <vector>

#include "numerics/hash_random.h"
#include "numerics/vec3.h"

namespace astrolith::testing {

inline Vec3d random_direction(CounterRandom& random) {
  return normalized(Vec3d{random.normal(), random.normal(), random.normal()});
}

inline Vec3d random_point(CounterRandom& random, const Box& box) {
  return {random.uniform(box.min.x, box.max.x), random.uniform(box.min.y, box.max.y),
          random.uniform(box.min.z, box.max.z)};
}

inline Box cube_about_origin(double half) { return {{-half, -half, -half}, {half, half, half}}; }

struct FloatPoints {
  FloatPoints() = default;
  FloatPoints(CounterRandom& random, const Box& box, std::size_t n) {
    while (x.size() < n) add(random_point(random, box));
  }
  void add(const Vec3d& p) {
    x.push_back(static_cast<float>(p.x));
    y.push_back(static_cast<float>(p.y));
    z.push_back(static_cast<float>(p.z));
  }

  std::vector<float> x, y, z;
};

}  // namespace astrolith::testing
