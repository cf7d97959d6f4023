// A noise layer of the recipe together with its own arrays, for users who need no field.
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
  // Takes the arguments of the make_noise() of this kind of layer.
  template <class AnyLayer>
  LoneNoise(const AnyLayer& layer, std::uint64_t seed, int layer_index, const Box& domain)
      : noise_(make_noise(layer, seed, layer_index, domain, arrays_)) {}

  // Writes height[i] = n(p_i), length units.
  void evaluate(int n, const float* x, const float* y, const float* z, float* height) const {
    evaluate_heights(noise_, arrays_.view(), n, x, y, z, height);
  }
  // A bound of |n(p)|, length units.
  double height_bound() const { return noise_.height_bound; }
  // An interval that holds n(p) for every float point p of the box, length units.
  Interval bound_heights(const Box& box) const {
    using astrolith::bound_heights;  // the functions of the noises, which this member hides
    return bound_heights(noise_, arrays_.view(), box);
  }

  const Noise& noise() const { return noise_; }
  ArrayView arrays() const { return arrays_.view(); }

 private:
  ArrayStore arrays_;
  Noise noise_;
};

}  // namespace astrolith
