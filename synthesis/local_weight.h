// Where a layer that is tied to a group of spheres counts (recipe's Locality; thesis 5.1), ready for
// evaluation over many points.
#pragma once

#include <string>
#include <vector>

#include "recipe/recipe.h"
#include "synthesis/noise_octaves.h"

namespace astrolith {

class LocalWeight {
 public:
  // Throws InputError, with the layer's name, when the body has no such group.
  LocalWeight(const Locality& locality, const MetaballBody& body, const std::string& layer = "layer");

  // height[i] *= the weight at p_i, in [0, 1].
  void multiply(int n, const float* x, const float* y, const float* z, float* height) const;

  // The weight at every float point of a box.
  Interval bound(const Box& box) const;

 private:
  std::vector<Sphere> near_, others_;  // the group's spheres and all others
  float inverse_width_;
};

}  // namespace astrolith
