// Where a layer that is tied to a group of spheres counts (recipe's Locality; thesis 5.1), ready for
// evaluation over many points.
#pragma once

#include <string>
#include <vector>

#include "numerics/interval.h"
#include "numerics/scalar_math.h"
#include "recipe/recipe.h"

namespace astrolith {

// The distance from a sphere's surface, or one that is less.
ASTROLITH_KERNEL float nearer_sphere(const Vec3f& center, float radius, float x, float y, float z,
                                     float distance) {
  const float dx = x - center.x, dy = y - center.y, dz = z - center.z;
  return math::min(distance, math::sqrt(math::fma(dx, dx, math::fma(dy, dy, dz * dz))) - radius);
}

// From the distances to the group's spheres and to all others.
ASTROLITH_KERNEL float local_weight(float near, float others, float inverse_width) {
  return math::fma(-2.0f, math::atan2_turns((near - others) * inverse_width, 1.0f), 0.5f);
}

// A sphere as points and boxes are measured from it.
struct WeightSphere {
  Vec3f center;
  float radius;
};

class LocalWeight {
 public:
  // Throws InputError, with the layer's name, when the body has no such group.
  LocalWeight(const Locality& locality, const MetaballBody& body, const std::string& layer = "layer");

  // height[i] *= the weight at p_i, in [0, 1].
  void multiply(int n, const float* x, const float* y, const float* z, float* height) const;

  // The weight at every float point of a box.
  Interval bound(const Box& box) const;

  const std::vector<WeightSphere>& near() const { return near_; }
  const std::vector<WeightSphere>& others() const { return others_; }  // none: the weight is 1 everywhere
  float inverse_width() const { return inverse_width_; }

 private:
  std::vector<WeightSphere> near_, others_;  // the group's spheres and all others
  float inverse_width_;
};

}  // namespace astrolith
