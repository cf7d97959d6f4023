// A fractal layer of the recipe, ready for evaluation over many points (thesis algorithm 4).
#pragma once

#include <cstdint>
#include <vector>

#include "recipe/recipe.h"

namespace astrolith {

class FractalNoise {
 public:
  // `layer_index` is the layer's number in the recipe: layers of one seed are independent. Points outside
  // `domain`, where no surface is, are moved to its border; octaves so fine that float coordinates within it
  // could not tell neighbouring cells apart (above 2^20 cells from the origin) are left out.
  FractalNoise(const FractalLayer& layer, std::uint64_t seed, int layer_index, const Box& domain);

  // height[i] = n(p_i), length units; scratch holds 3 n floats.
  void evaluate(int n, const float* x, const float* y, const float* z, float* height, float* scratch) const;

  // |n(p)| never exceeds this.
  double height_bound() const { return height_bound_; }

 private:
  struct Octave {
    float frequency;
    float amplitude;
    std::uint32_t seed;
  };

  Vec3f scale_, bias_, domain_min_, domain_max_;
  std::vector<Octave> octaves_;
  double height_bound_ = 0.0;
};

}  // namespace astrolith
