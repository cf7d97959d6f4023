// A noise of the recipe by itself, with arrays of its own, for whoever needs no field.
//
//   const LoneNoise<FractalNoise> noise(layer, seed, layer_index, domain);
//   noise.evaluate(n, x, y, z, height);
#pragma once

#include "numerics/arrays.h"
#include "numerics/interval.h"

namespace astrolith {

template <class Noise>
class LoneNoise {
 public:
  // The arguments of make_noise for the layer.
  template <class AnyLayer>
  LoneNoise(const AnyLayer& layer, std::uint64_t seed, int layer_index, const Box& domain)
      : noise_(make_noise(layer, seed, layer_index, domain, arrays_)) {}

  // height[i] = n(p_i), length units.
  void evaluate(int n, const float* x, const float* y, const float* z, float* height) const {
    evaluate_heights(noise_, arrays_.view(), n, x, y, z, height);
  }
  // |n(p)| never exceeds this, length units.
  double height_bound() const { return noise_.height_bound; }
  // n(p) at every float point of a box.
  Interval bound_heights(const Box& box) const {
    return astrolith::bound_heights(noise_, arrays_.view(), box);
  }

  const Noise& noise() const { return noise_; }
  ArrayView arrays() const { return arrays_.view(); }

 private:
  ArrayStore arrays_;
  Noise noise_;
};

}  // namespace astrolith
